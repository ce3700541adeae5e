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

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.rotation import cross
from tree_sway.core.setup.branch_places import Places
from tree_sway.core.setup.turning import turning_of
from tree_sway.core.tree import Tree


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
    first = places.first[:-1]
    on = places.base_segment
    branch = tree.branch_of_segment
    parent = np.maximum(places.parent, 0)
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
    by_down = rotations @ down
    by_arms = np.einsum('rqk,rk->qr', rotations, arms)
    crossed = (by_arms * load) @ by_down
    falling = np.repeat(load * (arms @ down), 3)
    flat = rotations.swapaxes(1, 2).reshape(-1, rotations.shape[1])
    straight = flat.T @ (falling[:, None] * flat)
    slopes = 0.5 * (crossed + crossed.T) - straight

    # The torque of the weight on the segments, and on all that is carried by each base.
    torque = np.cross(arms, load[:, None] * down)
    of_segments, of_branches = np.split(torque, [len(branch)])
    on_own = of_segments.copy()
    np.add.at(on_own, on[1:], of_branches[1:])
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


def _masses_beyond(places: Places, mass: Floats) -> tuple[Floats, Floats]:
    """Mass [kg] that the middle of each chord carries, (n,), and that of each subtree, (b,)."""
    seated = mass.copy()
    beyond = np.zeros(len(mass))
    carried = np.zeros(len(places.parent))
    for b in range(len(carried) - 1, -1, -1):
        own = slice(places.first[b], places.first[b + 1])
        from_tip = seated[own][::-1]
        onward = np.cumsum(from_tip)[::-1]
        beyond[own] = onward - seated[own] + 0.5 * mass[own]
        carried[b] = onward[0]
        if b > 0:
            seated[places.base_segment[b]] += carried[b]
    return beyond, carried
