# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""How far coordinates turn the parts of a tree: bases of branches, and segments on them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tree_sway.core.arrays import Floats, Ints
from tree_sway.core.setup.branch_places import Places
from tree_sway.core.setup.tree_motion import sum_outward
from tree_sway.core.tree import Tree


class Turning(NamedTuple):
    """Small rotations (..., q, 3) per unit of each coordinate."""

    joint: Floats
    """Rotation of each branch's base on its parent, (b, q, 3)."""
    base: Floats
    """Rotation of each branch's base from rest, (b, q, 3)."""
    own: Floats
    """Rotation of each segment on the base of its branch, (n, q, 3)."""


def turning_of(tree: Tree, places: Places, shapes: Floats) -> Turning:
    """Find the small rotations of bases and segments by shapes (N, q)."""
    parent = np.maximum(places.parent, 0)
    own = _rotations(places.segment_turn, tree.branch_of_segment, places, shapes)
    joint = _rotations(places.base_rotation, parent, places, shapes)
    joint[0] = 0.0
    return Turning(joint, sum_outward(places.parent, joint), own)


def _rotations(modes: Floats, branch: Ints, places: Places, shapes: Floats) -> Floats:
    """Rotation by each coordinate of what branches (r,) turn by modes (r, k, 3)."""
    each = np.arange(modes.shape[1])
    rows = np.minimum(places.coordinate[branch, None] + each, len(shapes) - 1)
    amounts = np.where((each < places.n_coordinates[branch, None])[..., None], shapes[rows], 0.0)
    return np.asarray(amounts.swapaxes(1, 2) @ modes)
