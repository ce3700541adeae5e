# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Inertia of a tree as it is bent.

The reduced equations have the inertia of the tree at rest. A tree that leans has a different one:
the crown of a bent stem swings sideways as the stem twists. Its slopes at rest follow from the
second derivatives of the positions of all segments, ``M_ij,k = sum m (p_ik p_j + p_i p_jk)``.
"""

from __future__ import annotations

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.beams.beam import cross
from tree_sway.core.model.fill_records import Places
from tree_sway.core.setup.tree_motion import levels_of, sum_outward
from tree_sway.core.setup.turning import turning_of
from tree_sway.core.tree.tree import Tree

LEADING = 12
"""
Number of coordinates whose inertia changes: those that do most of the motion.

The others are fast, and follow the load. Errors of trees of nine kinds are least with 6 to 14.
"""

MOST_CHANGE = 0.2
"""Largest change of the inertia of any motion, over that at rest."""


def inertia_slopes(tree: Tree, places: Places, shapes: Floats, mass: Floats) -> Floats:
    """
    Find how the inertia of the leading coordinates changes as each of them bends the tree.

    Parameters
    ----------
    tree, places
        Tree whose branches are reduced, and how these are joined.
    shapes
        Key rotations per unit of each coordinate, (N, m).
    mass
        Mass of each segment in [kg], (n,).

    Returns
    -------
    Floats
        Slopes of the inertia, the last axis the coordinate that bends the tree, (q, q, q).

    """
    lead, first, on = shapes[:, :LEADING], places.first[:-1], places.base_segment
    parent, levels = np.maximum(places.parent, 0), levels_of(places.parent)
    q, branch = lead.shape[1], tree.branch_of_segment
    joint, base, own = turning_of(tree, places, lead)
    arm = tree.start[first] - tree.start[on]
    arm[0] = 0.0
    below, here = base[parent], base[branch]
    whole = here + own

    def middles(chords: Floats, arms: Floats) -> Floats:
        """Add up the motion of segments and of bases on them, (n, q, 3) and (b, q, 3)."""
        before = np.cumsum(chords, axis=0) - chords
        before -= before[first][branch]
        joints = np.where(on[:, None, None] < 0, 0.0, before[on]) + arms
        moved = sum_outward(parent, levels, joints)[branch] + before + 0.5 * chords
        return moved.swapaxes(0, 1).reshape(q, 3 * len(branch))

    at_rest = middles(cross(whole, places.chord[:, None]), cross(whole[on], arm[:, None]))
    slopes = np.zeros((q, q, q))
    for k in range(q):
        # Rotations one after another do not commute: half of their cross products remains.
        order = cross(below, joint[:, k, None]) + cross(below[:, k, None], joint)
        orders = sum_outward(parent, levels, order)[branch]
        orders += cross(here, own[:, k, None]) + cross(here[:, k, None], own)
        bent = middles(
            _twice(whole, k, orders, places.chord), _twice(whole[on], k, orders[on], arm)
        )
        power = (bent * np.repeat(mass, 3)) @ at_rest.T
        slopes[:, :, k] = power + power.T
    return slopes


def inertia_change(slopes: Floats, at: Floats) -> Floats:
    """Change of the inertia of the leading coordinates at a pose (m,), bounded, (q, q)."""
    change: Floats = slopes @ at[: len(slopes)]
    return change * min(1.0, MOST_CHANGE / max(float(np.linalg.norm(change)), 1e-300))


def _twice(turn: Floats, k: int, order: Floats, arm: Floats) -> Floats:
    """Second derivative of arms (r, 3) by all coordinates and the one of number k, (r, q, 3)."""
    one, arm = turn[:, k, None], arm[:, None]
    both = cross(turn, cross(one, arm)) + cross(one, cross(turn, arm)) + cross(order, arm)
    return np.asarray(0.5 * both)
