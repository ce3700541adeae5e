# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
How the force of the weight changes as a tree leaves its rest, by the kinematics of its pose.

The potential of the weight is ``V = -sum m g . p``, with p the middles of the segments. Its
second derivative needs no places: each chord c, turned by small rotations ``w_i`` one after
another, moves all the mass beyond it, whose weight is G, by its own second derivative

    c_ik = (w_i x (w_k x c) + w_k x (w_i x c) + o_ik x c) / 2.

Rotations do not commute, so o_ik is the sum of the cross products of each rotation from the root
on with those before it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tree_sway.core.arrays import Floats, Ints
from tree_sway.core.beams.beam import cross
from tree_sway.core.model.fill_records import Places
from tree_sway.core.setup.tree_motion import levels_of, sum_outward
from tree_sway.core.tree.tree import Tree


class Turning(NamedTuple):
    """Small rotations (..., q, 3) per unit of each coordinate."""

    joint: Floats
    """Of each branch's base on its parent, (b, q, 3)."""
    base: Floats
    """Of each branch's base from rest, (b, q, 3)."""
    own: Floats
    """Of each segment on the base of its branch, (n, q, 3)."""


def weight_slopes(
    tree: Tree, places: Places, shapes: Floats, mass: Floats, gravity: float
) -> Floats:
    """
    Find the derivative of the weight's force on coordinates by each of them, at rest, (m, m).

    Parameters
    ----------
    tree, places
        Tree whose branches are reduced, and how these are joined.
    shapes
        Key rotations per unit of each coordinate, (N, m).
    mass
        Mass of each segment in [kg], (n,).
    gravity
        Gravity in [m/s^2].

    """
    first, on = places.first[:-1], places.base_segment
    branch, parent = tree.branch_of_segment, np.maximum(places.parent, 0)
    turning = turning_of(tree, places, shapes)
    whole = turning.base[branch] + turning.own
    arm = tree.start[first] - tree.start[on]
    arm[0] = 0.0
    beyond, carried = _masses_beyond(places, mass)
    # Chords rotate with their segment, and the arm of a branch with that which it sits on.
    arms = np.vstack([places.chord, arm])
    load = np.concatenate([beyond, carried])
    rotations = np.concatenate([whole, whole[on]])
    down = np.array([0.0, 0.0, -gravity])
    along, across = rotations @ down, np.einsum('rqk,rk->qr', rotations, arms)
    crossed = (across * load) @ along
    falling = np.repeat(load * (arms @ down), 3)
    flat = rotations.swapaxes(1, 2).reshape(-1, rotations.shape[1])
    slopes = 0.5 * (crossed + crossed.T) - flat.T @ (falling[:, None] * flat)

    # The torque of the weight on the segments, and on all that is carried by each base.
    torque = np.cross(arms, load[:, None] * down)
    n = len(branch)
    on_own = torque[:n].copy()
    np.add.at(on_own, on[1:], torque[n + 1 :])
    on_base = np.add.reduceat(on_own, first)
    for b in range(len(first) - 1, 0, -1):
        on_base[parent[b]] += on_base[b]
    for before, after, twist in (
        (turning.base[parent], turning.joint, on_base),
        (turning.base[branch], turning.own, on_own),
    ):
        turned = cross(after, twist[:, None])
        order = np.einsum('rik,rjk->ij', before, turned, optimize=True)
        slopes += 0.5 * (order + order.T)
    return np.asarray(slopes)


def turning_of(tree: Tree, places: Places, shapes: Floats) -> Turning:
    """Find the small rotations of bases and segments by shapes (N, q)."""
    parent = np.maximum(places.parent, 0)
    own = _rotations(places.rotation_mode, tree.branch_of_segment, places, shapes)
    joint = _rotations(places.base_rotation, parent, places, shapes)
    joint[0] = 0.0
    return Turning(joint, sum_outward(parent, levels_of(places.parent), joint), own)


def _masses_beyond(places: Places, mass: Floats) -> tuple[Floats, Floats]:
    """Mass [kg] that the middle of each chord carries, (n,), and that of each subtree, (b,)."""
    seated = mass.copy()
    beyond, carried = np.zeros(len(mass)), np.zeros(len(places.parent))
    for b in range(len(carried) - 1, -1, -1):
        own = slice(places.first[b], places.first[b + 1])
        onward = np.cumsum(seated[own][::-1])[::-1]
        beyond[own] = onward - seated[own] + 0.5 * mass[own]
        carried[b] = onward[0]
        if b > 0:
            seated[places.base_segment[b]] += carried[b]
    return beyond, carried


def _rotations(modes: Floats, branch: Ints, places: Places, shapes: Floats) -> Floats:
    """Rotation by each coordinate of what branches (r,) turn by modes (r, k, 3)."""
    each = np.arange(modes.shape[1])
    rows = np.minimum(places.coordinate[branch, None] + each, len(shapes) - 1)
    amounts = np.where((each < places.n_coordinates[branch, None])[..., None], shapes[rows], 0.0)
    return np.asarray(amounts.swapaxes(1, 2) @ modes)
