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
from tree_sway.core.rotation import cross
from tree_sway.core.setup.branch_places import Places
from tree_sway.core.setup.tree_motion import sum_outward
from tree_sway.core.setup.turning import turning_of
from tree_sway.core.tree import Tree

_LEADING = 12
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
    lead = shapes[:, :_LEADING]
    q = lead.shape[1]
    first = places.first[:-1]
    on = places.base_segment
    parent = np.maximum(places.parent, 0)
    branch = tree.branch_of_segment
    joint, base, own = turning_of(tree, places, lead)
    below = base[parent]
    here = base[branch]
    whole = here + own
    chord = places.chord
    arm = tree.start[first] - tree.start[on]
    arm[0] = 0.0

    def middles(chords: Floats, arms: Floats) -> Floats:
        """Add up the motion of segments (n, q, 3) and of bases on them, (b, q, 3)."""
        starts = np.cumsum(chords, axis=0) - chords
        starts -= starts[first][branch]
        on_parent = np.where(on[:, None, None] < 0, 0.0, starts[on])
        bases = sum_outward(places.parent, on_parent + arms)
        moved = bases[branch] + starts + 0.5 * chords
        return moved.swapaxes(0, 1).reshape(q, 3 * len(branch))

    on_whole = whole[on]
    """Rotation of the segment that each branch sits on, (b, q, 3)."""
    moved_chords = cross(whole, chord[:, None])
    moved_arms = cross(on_whole, arm[:, None])
    at_rest = middles(moved_chords, moved_arms)
    of_segments = np.repeat(mass, 3)
    slopes = np.zeros((q, q, q))
    for k in range(q):
        of_bases = _order(below, joint, k)
        order = sum_outward(places.parent, of_bases)[branch]
        order += _order(here, own, k)
        bent_chords = _second_derivative(whole, moved_chords, order, chord, k)
        bent_arms = _second_derivative(on_whole, moved_arms, order[on], arm, k)
        bent = middles(bent_chords, bent_arms)
        power = (bent * of_segments) @ at_rest.T
        slopes[:, :, k] = power + power.T
    return slopes


def inertia_change(slopes: Floats, at: Floats) -> Floats:
    """Change of the inertia of the leading coordinates at a pose (m,), bounded, (q, q)."""
    change: Floats = slopes @ at[: len(slopes)]
    size = max(float(np.linalg.norm(change)), 1e-300)
    return change * min(1.0, MOST_CHANGE / size)


def _order(inner: Floats, outer: Floats, k: int) -> Floats:
    """
    Add up what remains of the order of two rotations (r, q, 3), by all coordinates and number k.

    Rotations one after another do not commute: half of their cross products remains.
    """
    by_outer = cross(inner, outer[:, k, None])
    by_inner = cross(inner[:, k, None], outer)
    return np.asarray(by_outer + by_inner)


def _second_derivative(
    rotation: Floats, moved: Floats, order: Floats, arm: Floats, k: int
) -> Floats:
    """
    Differentiate arms a (r, 3) by all coordinates i and the one of number k, (r, q, 3).

    With rotations w (r, q, 3), ``w_i x a`` as `moved` and their `_order` o it is
    ``[w_i x (w_k x a) + w_k x (w_i x a) + o_ik x a] / 2``.
    """
    twice = cross(rotation, moved[:, k, None])
    twice += cross(rotation[:, k, None], moved)
    twice += cross(order, arm[:, None])
    return np.asarray(0.5 * twice)
