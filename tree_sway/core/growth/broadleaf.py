# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A broadleaf in the open: a trunk that divides into limbs, and a crown of its species' form.

Limbs and their branches grow towards the outline of the crown and end inside it, which shapes the
crown.
"""

from __future__ import annotations

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.growth.axis import aim, direction_of, GOLDEN_ANGLE, grow_axis, heading_of
from tree_sway.core.growth.forms import broadleaf_form, BroadleafForm
from tree_sway.core.growth.skeleton import Skeleton
from tree_sway.core.growth.thickness import finished_tree
from tree_sway.core.growth.twigs import add_twigs
from tree_sway.core.tree.tree import Tree

_N_NODES = 12


def grow_broadleaf(
    rng: np.random.Generator,
    height: float = 8.0,
    diameter: float = 0.18,
    species: str = 'broadleaf',
    form: BroadleafForm | None = None,
) -> Tree:
    """
    Grow a tree with a trunk, limbs, branches and twigs, as in `finished_tree`.

    ``form`` is that of the species if None. The same state of the source of randomness gives the
    same tree.
    """
    form, skeleton = form or broadleaf_form(species), Skeleton()

    def add_limb(at: int, azimuth: float, here: float) -> None:
        """Add a limb at a height of the trunk, from 0 at the lowest limb to 1, with branches."""
        origin = skeleton.shoots[trunk].nodes[at]
        (low, high), (bent_low, bent_high) = form.rise, form.turn
        rise = low + (high - low) * here + rng.uniform(-0.1, 0.1)
        end = min(rise + bent_low + (bent_high - bent_low) * here, 1.4)
        heading = direction_of(azimuth, 0.5 * (rise + end))
        length = max(0.85 * form.outline.room(origin, heading), 0.08) * rng.uniform(0.85, 1.0)
        axis = grow_axis(origin, azimuth, (rise, end), length, 8, rng, wander=form.wander)
        limb = skeleton.add(axis, trunk, at)
        roll = rng.uniform(0.0, np.pi)
        nodes = np.linspace(2.0, 8.0, form.n_branches).round().astype(int)
        for i, node in enumerate(nodes.tolist()):
            side = roll + _turn_of(i, form.is_opposite) + rng.uniform(-0.3, 0.3)
            angle = form.spread * rng.uniform(0.8, 1.2)
            add_branch(limb, node, aim(skeleton.shoots[limb].tangent(node), angle, side))

    def add_branch(limb: int, at: int, heading: Floats) -> None:
        """Add a branch of a limb with its twigs in a flat spray."""
        origin = skeleton.shoots[limb].nodes[at]
        azimuth, rise = heading_of(heading)
        longest = 0.55 * form.outline.half_width
        length = float(np.clip(0.85 * form.outline.room(origin, heading), 0.06, longest))
        length *= rng.uniform(0.8, 1.0)
        ends = rise, float(np.clip(rise + form.branch_turn, -1.3, 1.4))
        segments, wander = 6 if length > 0.1 else 4, 1.2 * form.wander
        axis = grow_axis(origin, azimuth, ends, length, segments, rng, wander=wander, floor=0.03)
        branch, sides = skeleton.add(axis, limb, at), (0.2, np.pi - 0.2)
        add_twigs(skeleton, branch, form.twig, 0.75, sides, first_node=2, lift=form.lift)

    facing, wander = rng.uniform(0.0, 2.0 * np.pi), 0.6 * form.wander
    steep = (1.57, 1.47)
    trunk = skeleton.add(
        grow_axis(np.zeros(3), facing, steep, form.trunk, _N_NODES, rng, wander=wander)
    )
    lowest = max(1, round(form.bole / form.trunk * _N_NODES))
    nodes = np.linspace(lowest, _N_NODES, form.n_limbs).round().astype(int)
    if form.is_opposite:
        nodes = nodes[np.arange(form.n_limbs) // 2 * 2]
    roll = rng.uniform(0.0, 2.0 * np.pi)
    for i, node in enumerate(nodes.tolist()):
        azimuth = roll + _turn_of(i, form.is_opposite) + rng.uniform(-0.15, 0.15)
        add_limb(node, azimuth, (node - lowest) / (_N_NODES - lowest))
    law = {'exponent': form.exponent, 'bole_taper': form.taper}
    return finished_tree(skeleton, height, diameter, species, **law)


def _turn_of(i: int, is_opposite: bool) -> float:
    """Azimuth about a shoot of its i-th side shoot in [rad]: in a spiral, or in crossed pairs."""
    return float((i % 2 + i // 2 * 0.5) * np.pi) if is_opposite else float(i * GOLDEN_ANGLE)
