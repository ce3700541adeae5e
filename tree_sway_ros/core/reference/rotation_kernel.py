"""Vectors of three and rotations, compiled by numba: products, exponential, logarithm."""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

Floats = NDArray[np.float64]


@njit(cache=True)
def cross(a: Floats, b: Floats) -> Floats:
    """Vector product of two vectors, (3,)."""
    out = np.empty(3)
    out[0] = a[1] * b[2] - a[2] * b[1]
    out[1] = a[2] * b[0] - a[0] * b[2]
    out[2] = a[0] * b[1] - a[1] * b[0]
    return out


@njit(cache=True)
def rotate(matrix: Floats, vector: Floats) -> Floats:
    """Matrix (3, 3) times vector (3,)."""
    out = np.empty(3)
    for k in range(3):
        out[k] = (
            matrix[k, 0] * vector[0] + matrix[k, 1] * vector[1] + matrix[k, 2] * vector[2]
        )
    return out


@njit(cache=True)
def outer_add(matrix: Floats, a: Floats, b: Floats, factor: float) -> None:
    """Add ``factor a b^T`` to a matrix (3, 3)."""
    for i in range(3):
        for j in range(3):
            matrix[i, j] += factor * a[i] * b[j]


@njit(cache=True)
def inverse_3(matrix: Floats, out: Floats) -> None:
    """Inverse of a matrix (3, 3) by its adjugate."""
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        for m in range(3):
            p, q = (m + 1) % 3, (m + 2) % 3
            out[m, i] = matrix[j, p] * matrix[k, q] - matrix[j, q] * matrix[k, p]
    det = matrix[0, 0] * out[0, 0] + matrix[0, 1] * out[1, 0] + matrix[0, 2] * out[2, 0]
    out /= det


@njit(cache=True)
def multiply(p: Floats, q: Floats, out: Floats) -> None:
    """Product of two quaternions wxyz, (4,), brought back to unit length."""
    w = p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3]
    x = p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2]
    y = p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1]
    z = p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0]
    norm = math.sqrt(w * w + x * x + y * y + z * z)
    out[0], out[1], out[2], out[3] = w / norm, x / norm, y / norm, z / norm


@njit(cache=True)
def exponential(v: Floats) -> Floats:
    """Quaternion wxyz of a rotation vector (3,) in [rad]."""
    square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2]
    half = 0.5 * math.sqrt(square)
    factor = 0.5 - square / 48.0 if square < 1e-6 else math.sin(half) / (2.0 * half)
    out = np.empty(4)
    out[0] = math.cos(half)
    for k in range(3):
        out[1 + k] = factor * v[k]
    return out


@njit(cache=True)
def logarithm(q: Floats) -> Floats:
    """Rotation vector (3,) in [rad] of a quaternion wxyz; the short way round."""
    sine = math.sqrt(q[1] * q[1] + q[2] * q[2] + q[3] * q[3])
    sign = -1.0 if q[0] < 0.0 else 1.0
    factor = 2.0 * sign if sine < 1e-9 else 2.0 * math.atan2(sine, sign * q[0]) / sine * sign
    out = np.empty(3)
    for k in range(3):
        out[k] = factor * q[1 + k]
    return out


@njit(cache=True)
def matrix_of(q: Floats, out: Floats) -> None:
    """Rotation matrix (3, 3) of a quaternion wxyz."""
    w, x, y, z = q[0], q[1], q[2], q[3]
    out[0, 0], out[0, 1] = 1 - 2 * (y * y + z * z), 2 * (x * y - w * z)
    out[0, 2], out[1, 0] = 2 * (x * z + w * y), 2 * (x * y + w * z)
    out[1, 1], out[1, 2] = 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)
    out[2, 0], out[2, 1] = 2 * (x * z - w * y), 2 * (y * z + w * x)
    out[2, 2] = 1 - 2 * (x * x + y * y)


@njit(cache=True)
def conjugate_torque(v: Floats, gradient: Floats) -> Floats:
    """
    Torque of a spring whose energy has this gradient (3,) by the rotation vector v (3,), body axes.

    That is ``-J^-T gradient`` with J the right Jacobian of the exponential map (Chirikjian 2012, 10.86).

    """
    square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2]
    if square < 1e-4:
        second = 1.0 / 12.0 + square / 720.0
    else:
        angle = math.sqrt(square)
        second = (1.0 - 0.5 * angle / math.tan(0.5 * angle)) / square
    once = cross(v, gradient)
    return -gradient + 0.5 * once - second * cross(v, once)
