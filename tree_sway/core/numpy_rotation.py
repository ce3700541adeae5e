# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Rotations and the two-axis branch on whole arrays, in plain numpy.

Quaternions are w x y z, (n, 4); vectors are (n, 3).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.core.arrays import Floats
from tree_sway.core.oscillators.two_axis import T_MAX

_SMALL = 1e-6


def quaternions_of(vectors: Floats) -> Floats:
    """Return the unit quaternions of rotation vectors in [rad]."""
    half = 0.5 * np.linalg.norm(vectors, axis=1)[:, None]
    quaternions = np.empty((len(vectors), 4))
    quaternions[:, :1] = np.cos(half)
    quaternions[:, 1:] = 0.5 * np.sinc(half / np.pi) * vectors
    return quaternions


def cross(a: Floats, b: Floats) -> Floats:
    """Cross products of vectors."""
    ax, ay, az = a.T
    bx, by, bz = b.T
    # Three times as fast as to stack the components, and most of the time of a small tree.
    product = np.empty((len(a), 3))
    np.subtract(ay * bz, az * by, out=product[:, 0])
    np.subtract(az * bx, ax * bz, out=product[:, 1])
    np.subtract(ax * by, ay * bx, out=product[:, 2])
    return product


def quaternion_product(a: Floats, b: Floats) -> Floats:
    """Return the quaternions of b followed by a."""
    product = np.empty((len(a), 4))
    product[:, 0] = a[:, 0] * b[:, 0] - np.einsum('bi,bi->b', a[:, 1:], b[:, 1:])
    vector = a[:, :1] * b[:, 1:] + b[:, :1] * a[:, 1:]
    np.add(vector, cross(a[:, 1:], b[:, 1:]), out=product[:, 1:])
    return product


def quaternion_rotated(q: Floats, vectors: Floats) -> Floats:
    """Rotate vectors by unit quaternions."""
    twice = 2.0 * cross(q[:, 1:], vectors)
    return np.asarray(vectors + q[:, :1] * twice + cross(q[:, 1:], twice))


def turned_by(rotations: Floats, vectors: Floats) -> Floats:
    """Turn vectors (n, 3) by rotation vectors [rad], (n, 3), as `rotation.turned`."""
    t = np.einsum('bi,bi->b', rotations, rotations)[:, None]
    half = (0.5 + t * (1.0 / 24.0 + t * (1.0 / 240.0 + t * (17.0 / 40320.0)))) * rotations
    square = np.einsum('bi,bi->b', half, half)[:, None]
    along = np.einsum('bi,bi->b', half, vectors)[:, None]
    turned = (1.0 - square) * vectors + 2.0 * along * half + 2.0 * cross(half, vectors)
    return np.asarray(turned / (1.0 + square))


def within_guard(e: Floats) -> Floats:
    """Pull rotation vectors (n, 2) back to the circle of `oscillators.two_axis`."""
    squares = np.square(e).sum(axis=1, keepdims=True)
    return np.asarray(e * np.sqrt(T_MAX / np.maximum(squares, T_MAX)))


def two_axis_moment(e: Floats, v: Floats, load: Floats, gyro: Floats, limit: ArrayLike) -> Floats:
    """
    Moment of a force on the two axes of each branch, with the gyroscopic term, clamped to a limit.

    The formulas of `oscillators.two_axis`, with sines and cosines.

    Parameters
    ----------
    e, v
        Rotation vector in [rad] and its rate in [rad/s], (n, 2).
    load
        Force times lever along b, e1, e2 in [N m], (n, 3).
    gyro, limit
        Inertia of the gyroscopic term in [kg m^2] and largest moment in [N m], (n,).

    Returns
    -------
    Floats
        Moment in [N m], (n, 2).

    """
    e = within_guard(e)
    t = np.square(e).sum(axis=1)
    angle = np.sqrt(t)
    sinc, cos = np.sinc(angle / np.pi), np.cos(angle)
    some = np.maximum(t, _SMALL)
    radial = np.where(t < _SMALL, -2.0 / 3.0 + t / 45.0, (cos - 1.0 / sinc) / some)
    sphere = np.where(t < _SMALL, -2.0 / 3.0 + 2.0 * t / 15.0, (sinc * cos - 1.0) / some)
    turning = np.where(t < _SMALL, 1.0 / 3.0 + t / 45.0, (1.0 - cos / sinc) / some)
    dot = (e * load[:, 1:]).sum(axis=1)
    moment = load[:, 1:] / sinc[:, None] + e * (dot * radial - load[:, 0] * sinc)[:, None]
    spin = e[:, 0] * v[:, 1] - e[:, 1] * v[:, 0]
    per_square = np.divide(gyro * spin, t, out=np.zeros_like(t), where=t > 0.0)
    side = np.stack([-e[:, 1], e[:, 0]], axis=1)
    along = 2.0 * (e * v).sum(axis=1) * turning
    moment = moment + per_square[:, None] * ((sphere * spin)[:, None] * e + along[:, None] * side)
    size = np.linalg.norm(moment, axis=1)
    scale = np.minimum(1.0, np.asarray(limit) / np.maximum(size, 1e-300))
    return np.asarray(moment * scale[:, None])
