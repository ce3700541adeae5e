# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Rotations of whole arrays of vectors, in plain numpy.

Quaternions are w x y z, (n, 4); vectors are (n, 3).
"""

from __future__ import annotations

import math

import numpy as np

from tree_sway.core.arrays import Floats

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


def about_up(angle: float) -> Floats:
    """Rotation about the vertical by an angle [rad], counterclockwise seen from above, (3, 3)."""
    c = math.cos(angle)
    s = math.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def quaternion_rotated(quaternions: Floats, vectors: Floats) -> Floats:
    """Rotate vectors by unit quaternions (w, q): ``v + 2 w q x v + 2 q x (q x v)``."""
    real = quaternions[:, :1]
    axis = quaternions[:, 1:]
    twice = 2.0 * cross(axis, vectors)
    return np.asarray(vectors + real * twice + cross(axis, twice))


def quaternions_of_axes(along: Floats, normal: Floats) -> Floats:
    """Return unit quaternions w, x, y, z (..., 4) that rotate x and z to unit vectors (..., 3)."""
    from scipy.spatial.transform import Rotation  # it takes long to load, and few need it

    axes = np.stack([along, np.cross(normal, along), normal], axis=-1)
    return np.asarray(Rotation.from_matrix(axes).as_quat()[..., [3, 0, 1, 2]])
