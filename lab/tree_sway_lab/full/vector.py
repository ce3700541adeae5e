# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Vectors of the hot path, as triples of floats.

They are compiled into their callers, without arrays or allocation.
"""

from __future__ import annotations

from tree_sway.core.arrays import Floats
from tree_sway_lab.full.rotation import turned
from tree_sway_lab.kernel import part

Vector = tuple[float, float, float]


@part
def vector(values: Floats, first: int) -> Vector:
    """Read three values of an array from an index on."""
    return values[first], values[first + 1], values[first + 2]


@part
def column(rows: Floats, first: int, j: int) -> Vector:
    """Read column j of three rows of an array from a row on."""
    return rows[first, j], rows[first + 1, j], rows[first + 2, j]


@part
def put(v: Vector, values: Floats, first: int) -> None:
    """Write a vector to an array from an index on."""
    values[first] = v[0]
    values[first + 1] = v[1]
    values[first + 2] = v[2]


@part
def put_column(v: Vector, rows: Floats, j: int) -> None:
    """Write a vector to column j of the first three rows of an array."""
    rows[0, j] = v[0]
    rows[1, j] = v[1]
    rows[2, j] = v[2]


@part
def plus(a: Vector, b: Vector) -> Vector:
    """Return a + b."""
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


@part
def plus_times(a: Vector, factor: float, b: Vector) -> Vector:
    """Return a + factor b."""
    return a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]


@part
def times(factor: float, v: Vector) -> Vector:
    """Return a multiple of a vector."""
    return factor * v[0], factor * v[1], factor * v[2]


@part
def minus(a: Vector, b: Vector) -> Vector:
    """Return a - b."""
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


@part
def dot(a: Vector, b: Vector) -> float:
    """Return the scalar product."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@part
def cross(a: Vector, b: Vector) -> Vector:
    """Return the vector product a x b."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@part
def turned_by(rotation: Vector, v: Vector) -> Vector:
    """Rotate a vector by a rotation vector, as `rotation.turned`."""
    return turned(rotation[0], rotation[1], rotation[2], v[0], v[1], v[2])


@part
def turned_back(rotation: Vector, v: Vector) -> Vector:
    """Rotate a vector by the opposite of a rotation vector, as `rotation.turned`."""
    return turned(-rotation[0], -rotation[1], -rotation[2], v[0], v[1], v[2])
