# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The last step of every importer: segments to a `Tree`, with errors that name the file."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.core.arrays import Floats
from tree_sway.core.tree import Tree, tree_from_segments
from tree_sway.errors import FormatError, TreeError


def nearest_axis(start: Floats, end: Floats, point: Floats) -> tuple[int, float]:
    """Return the number of the axis (n, 3) nearest to a point, and its distance [m]."""
    axis = end - start
    squared = np.maximum(np.einsum('ij,ij->i', axis, axis), 1e-24)
    along = np.clip(np.einsum('ij,ij->i', point - start, axis) / squared, 0.0, 1.0)
    distance = np.linalg.norm(start + along[:, None] * axis - point, axis=1)
    best = int(np.argmin(distance))
    return best, float(distance[best])


def built_tree(
    source: str, start: ArrayLike, end: ArrayLike, diameter: Sequence[Any] | Floats, **more: Any
) -> Tree:
    """
    Build a tree with `tree_from_segments`, of the same arguments, from a file.

    Errors are those of that function, and a `FormatError` without segments.
    """
    if not len(diameter):
        raise FormatError('no segments', where=source, cure='give at least one segment')
    try:
        return tree_from_segments(start, end, diameter, **more)
    except TreeError as error:
        raise error.at(error.where or source) from error
