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
    angle = np.linalg.norm(vectors, axis=1)
    half = 0.5 * angle[:, None]
    quaternions = np.empty((len(vectors), 4))
    quaternions[:, :1] = np.cos(half)
    quaternions[:, 1:] = 0.5 * np.sinc(half / np.pi) * vectors
    return quaternions


CYCLES = (0, 1, 2), (1, 2, 0), (2, 0, 1)
"""Cyclic permutations of the axes x, y, z."""


def cross(a: Floats, b: Floats) -> Floats:
    """Cross products along the last axis, (..., 3); numpy's own take several times as long."""
    product = np.empty(np.broadcast_shapes(a.shape, b.shape))
    for i, j, k in CYCLES:
        product[..., i] = a[..., j] * b[..., k] - a[..., k] * b[..., j]
    return product


def cross_matrix(v: Floats) -> Floats:
    """Matrices whose product with a vector is the cross product of v with it, (..., 3, 3)."""
    matrix = np.zeros((*v.shape, 3))
    for i, j, k in CYCLES:
        matrix[..., k, j] = v[..., i]
        matrix[..., j, k] = -v[..., i]
    return matrix


def quaternion_product(a: Floats, b: Floats) -> Floats:
    """Return the quaternions of b followed by a."""
    real_a = a[:, :1]
    real_b = b[:, :1]
    vector_a = a[:, 1:]
    vector_b = b[:, 1:]
    product = np.empty((len(a), 4))
    product[:, :1] = real_a * real_b - _dot(vector_a, vector_b)
    vector = real_a * vector_b + real_b * vector_a
    product[:, 1:] = vector + cross(vector_a, vector_b)
    return product


def _dot(a: Floats, b: Floats) -> Floats:
    """Scalar products of vectors, (n, 1)."""
    products = np.einsum('bi,bi->b', a, b)
    return np.asarray(products[:, None])


def quaternion_rotated(quaternions: Floats, vectors: Floats) -> Floats:
    """Rotate vectors by unit quaternions (w, q): ``v + 2 w q x v + 2 q x (q x v)``."""
    real = quaternions[:, :1]
    axis = quaternions[:, 1:]
    twice = 2.0 * cross(axis, vectors)
    return np.asarray(vectors + real * twice + cross(axis, twice))


def turned_by(rotations: Floats, vectors: Floats) -> Floats:
    """
    Turn vectors v (n, 3) by rotation vectors [rad], (n, 3), as `rotation.turned`.

    With h the axis times the tangent of half the angle (Rodrigues) it is
    ``[(1 - h.h) v + 2 (h.v) h + 2 h x v] / (1 + h.h)``.
    """
    angle_square = _dot(rotations, rotations)
    h = _half_tangent(angle_square) * rotations
    h_square = _dot(h, h)
    along = _dot(h, vectors)
    turned = (1.0 - h_square) * vectors
    turned += 2.0 * along * h
    turned += 2.0 * cross(h, vectors)
    turned /= 1.0 + h_square
    return turned


def _half_tangent(t: Floats) -> Floats:
    """Tangent of half an angle over the angle, by its series in the square t of the angle."""
    return 0.5 + t * (1.0 / 24.0 + t * (1.0 / 240.0 + t * (17.0 / 40320.0)))
