# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Rotations of whole arrays of vectors, in plain numpy.

Quaternions are w x y z, (n, 4); vectors are (n, 3).
"""

from __future__ import annotations

import numpy as np

from tree_sway.core.arrays import Floats


def quaternions_of(vectors: Floats) -> Floats:
    """Return the unit quaternions of rotation vectors in [rad]."""
    half = 0.5 * np.linalg.norm(vectors, axis=1)[:, None]
    quaternions = np.empty((len(vectors), 4))
    quaternions[:, :1] = np.cos(half)
    quaternions[:, 1:] = 0.5 * np.sinc(half / np.pi) * vectors
    return quaternions


def cross(a: Floats, b: Floats) -> Floats:
    """Cross products of vectors."""
    # Three times as fast as `np.cross`, and most of the time of a small tree.
    product = np.empty((len(a), 3))
    for axis, (one, two) in enumerate(((1, 2), (2, 0), (0, 1))):
        np.subtract(a[:, one] * b[:, two], a[:, two] * b[:, one], out=product[:, axis])
    return product


def quaternion_product(a: Floats, b: Floats) -> Floats:
    """Return the quaternions of b followed by a."""
    real_a, vector_a = a[:, :1], a[:, 1:]
    real_b, vector_b = b[:, :1], b[:, 1:]
    product = np.empty((len(a), 4))
    product[:, :1] = real_a * real_b - _dot(vector_a, vector_b)
    product[:, 1:] = real_a * vector_b + real_b * vector_a + cross(vector_a, vector_b)
    return product


def _dot(a: Floats, b: Floats) -> Floats:
    """Scalar products of vectors, (n, 1)."""
    return np.asarray(np.einsum('bi,bi->b', a, b)[:, None])


def quaternion_rotated(quaternions: Floats, vectors: Floats) -> Floats:
    """Rotate vectors by unit quaternions."""
    real, axis = quaternions[:, :1], quaternions[:, 1:]
    twice = 2.0 * cross(axis, vectors)
    return np.asarray(vectors + real * twice + cross(axis, twice))


def turned_by(rotations: Floats, vectors: Floats) -> Floats:
    """Turn vectors (n, 3) by rotation vectors [rad], (n, 3), as `rotation.turned`."""
    angle_square = _dot(rotations, rotations)
    half = _half_tangent(angle_square) * rotations
    square = _dot(half, half)
    along = _dot(half, vectors)
    turned = (1.0 - square) * vectors + 2.0 * along * half + 2.0 * cross(half, vectors)
    return np.asarray(turned / (1.0 + square))


def _half_tangent(t: Floats) -> Floats:
    """Tangent of half an angle over the angle, by its series in the square t of the angle."""
    return 0.5 + t * (1.0 / 24.0 + t * (1.0 / 240.0 + t * (17.0 / 40320.0)))
