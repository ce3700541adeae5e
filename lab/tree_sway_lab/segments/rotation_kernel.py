# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Vectors as triples of floats, and rotations, compiled into their callers without allocation."""

from __future__ import annotations

import math

from tree_sway.core.arrays import Floats
from tree_sway_lab.kernel import kernel

Vector = tuple[float, float, float]
Quaternion = Floats | tuple[float, float, float, float]


@kernel
def read(array: Floats, i: int) -> Vector:
    """Row i of an array (n, 3)."""
    return array[i, 0], array[i, 1], array[i, 2]


@kernel
def write(array: Floats, i: int, v: Vector) -> None:
    """Set row i of an array (n, 3)."""
    array[i, 0], array[i, 1], array[i, 2] = v


@kernel
def plus(a: Vector, b: Vector, factor: float) -> Vector:
    """Vector ``a + factor b``."""
    return a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]


@kernel
def dot(a: Vector, b: Vector) -> float:
    """Scalar product."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@kernel
def cross(a: Vector, b: Vector) -> Vector:
    """Vector product."""
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


@kernel
def times(m: Floats, v: Vector) -> Vector:
    """Matrix (3, 3) times vector."""
    return (
        m[0, 0] * v[0] + m[0, 1] * v[1] + m[0, 2] * v[2],
        m[1, 0] * v[0] + m[1, 1] * v[1] + m[1, 2] * v[2],
        m[2, 0] * v[0] + m[2, 1] * v[1] + m[2, 2] * v[2],
    )


@kernel
def times_transposed(m: Floats, v: Vector) -> Vector:
    """Transposed matrix (3, 3) times vector."""
    return (
        m[0, 0] * v[0] + m[1, 0] * v[1] + m[2, 0] * v[2],
        m[0, 1] * v[0] + m[1, 1] * v[1] + m[2, 1] * v[2],
        m[0, 2] * v[0] + m[1, 2] * v[1] + m[2, 2] * v[2],
    )


@kernel
def product(a: Floats, b: Floats, out: Floats) -> None:
    """Product of two matrices (3, 3)."""
    for i in range(3):
        for j in range(3):
            out[i, j] = a[i, 0] * b[0, j] + a[i, 1] * b[1, j] + a[i, 2] * b[2, j]


@kernel
def cross_columns(v: Vector, m: Floats, out: Floats) -> None:
    """Vector product of v with each column of a matrix (3, 3)."""
    for j in range(3):
        out[0, j] = v[1] * m[2, j] - v[2] * m[1, j]
        out[1, j] = v[2] * m[0, j] - v[0] * m[2, j]
        out[2, j] = v[0] * m[1, j] - v[1] * m[0, j]


@kernel
def inverse(m: Floats, out: Floats) -> None:
    """Inverse of a matrix (3, 3) by its adjugate."""
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        for r in range(3):
            p, q = (r + 1) % 3, (r + 2) % 3
            out[r, i] = m[j, p] * m[k, q] - m[j, q] * m[k, p]
    scale = 1.0 / (m[0, 0] * out[0, 0] + m[0, 1] * out[1, 0] + m[0, 2] * out[2, 0])
    for i in range(3):
        for j in range(3):
            out[i, j] *= scale


@kernel
def turn_on(q: Quaternion, v: Vector, out: Floats) -> None:
    """Turn a unit quaternion wxyz (4,) on by a rotation vector in its own axes in [rad]."""
    square = dot(v, v)
    half = 0.5 * math.sqrt(square)
    factor = 0.5 - square / 48.0 if square < 1e-6 else math.sin(half) / (2.0 * half)
    pw, px, py, pz = math.cos(half), factor * v[0], factor * v[1], factor * v[2]
    w = q[0] * pw - q[1] * px - q[2] * py - q[3] * pz
    x = q[0] * px + q[1] * pw + q[2] * pz - q[3] * py
    y = q[0] * py - q[1] * pz + q[2] * pw + q[3] * px
    z = q[0] * pz + q[1] * py - q[2] * px + q[3] * pw
    scale = 1.0 / math.sqrt(w * w + x * x + y * y + z * z)
    out[0], out[1], out[2], out[3] = scale * w, scale * x, scale * y, scale * z


@kernel
def logarithm(q: Quaternion) -> Vector:
    """Rotation vector in [rad] of a quaternion wxyz (4,); the short way round."""
    sine = math.sqrt(q[1] * q[1] + q[2] * q[2] + q[3] * q[3])
    sign = -1.0 if q[0] < 0.0 else 1.0
    factor = 2.0 * sign if sine < 1e-9 else 2.0 * math.atan2(sine, sign * q[0]) / sine * sign
    return factor * q[1], factor * q[2], factor * q[3]


@kernel
def matrix_of(q: Quaternion, out: Floats) -> None:
    """Rotation matrix (3, 3) of a quaternion wxyz (4,)."""
    w, x, y, z = q[0], q[1], q[2], q[3]
    out[0, 0], out[0, 1] = 1 - 2 * (y * y + z * z), 2 * (x * y - w * z)
    out[0, 2], out[1, 0] = 2 * (x * z + w * y), 2 * (x * y + w * z)
    out[1, 1], out[1, 2] = 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)
    out[2, 0], out[2, 1] = 2 * (x * z - w * y), 2 * (y * z + w * x)
    out[2, 2] = 1 - 2 * (x * x + y * y)


@kernel
def twist_of(q: Quaternion, t: Vector) -> tuple[float, Vector]:
    """
    Angle in [rad] that a quaternion wxyz (4,) turns about an axis, and its gradient in body axes.

    Swing and twist: the rotation is one about the axis and one across it (Dobrowolski 2015).
    """
    w, v = q[0], (q[1], q[2], q[3])
    about = dot(v, t)
    scale = 1.0 / (w * w + about * about)
    gradient = plus((0.0, 0.0, 0.0), t, w * w * scale)
    gradient = plus(plus(gradient, cross(t, v), w * scale), v, about * scale)
    sign = -1.0 if w < 0.0 else 1.0
    return 2.0 * math.atan2(sign * about, sign * w), gradient


@kernel
def held_torque(v: Vector, torque: Vector) -> Vector:
    """
    Torque in body axes whose work over rotation vectors v is that of a constant one.

    That is ``J^-T torque`` with J the right Jacobian of the exponential map (Chirikjian 2012,
    10.86).
    """
    square = dot(v, v)
    if square < 1e-4:
        second = 1.0 / 12.0 + square / 720.0
    else:
        angle = math.sqrt(square)
        second = (1.0 - 0.5 * angle / math.tan(0.5 * angle)) / square
    once = cross(v, torque)
    return plus(plus(torque, once, -0.5), cross(v, once), second)
