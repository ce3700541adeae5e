# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A broadleaf in the open: a trunk that divides into limbs, and a crown of its species' form.

Limbs and their branches grow towards the outline of the crown and end inside it, which shapes the
crown.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.tree import Tree
from tree_sway.growth.axis import aim, direction_of, GOLDEN_ANGLE, grow_axis, heading_of
from tree_sway.growth.forms import broadleaf_form, BroadleafForm
from tree_sway.growth.skeleton import Skeleton
from tree_sway.growth.thickness import finished_tree
from tree_sway.growth.twigs import add_twigs

_N_NODES = 12
_STEEP = (1.57, 1.47)
"""Angle of the trunk above the horizon at its foot and its top in [rad]."""
_STEEPEST = 1.4
"""Largest angle of the end of a limb or branch above the horizon in [rad]."""


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
    growth = _Growth(rng, form or broadleaf_form(species), Skeleton())
    growth.add_trunk_and_limbs()
    law = {'exponent': growth.form.exponent, 'bole_taper': growth.form.taper}
    return finished_tree(growth.skeleton, height, diameter, species, **law)


@dataclass(frozen=True)
class _Growth:
    """
    A tree that grows from the trunk to the twigs, in lengths over its height.

    The order of random numbers is part of each built-in tree.
    """

    rng: np.random.Generator
    form: BroadleafForm
    skeleton: Skeleton

    def add_trunk_and_limbs(self) -> None:
        """Add the trunk and its limbs, from the lowest to the top."""
        form = self.form
        rng = self.rng
        facing = rng.uniform(0.0, 2.0 * np.pi)
        axis = grow_axis(
            np.zeros(3), facing, _STEEP, form.trunk, _N_NODES, rng, wander=0.6 * form.wander
        )
        trunk = self.skeleton.add(axis)
        lowest = max(1, round(form.bole / form.trunk * _N_NODES))
        nodes = np.linspace(lowest, _N_NODES, form.n_limbs).round().astype(int)
        if form.is_opposite:
            nodes = nodes[np.arange(form.n_limbs) // 2 * 2]
        roll = rng.uniform(0.0, 2.0 * np.pi)
        for i, node in enumerate(nodes.tolist()):
            azimuth = roll + _turn_of(i, form.is_opposite) + rng.uniform(-0.15, 0.15)
            self._add_limb(trunk, node, azimuth, (node - lowest) / (_N_NODES - lowest))

    def _add_limb(self, trunk: int, at: int, azimuth: float, height: float) -> None:
        """Add a limb at a height of the trunk, from 0 at the lowest limb to 1, with branches."""
        form = self.form
        rng = self.rng
        origin = self.skeleton.shoots[trunk].nodes[at]
        (low, high), (bent_low, bent_high) = form.rise, form.turn
        rise = low + (high - low) * height + rng.uniform(-0.1, 0.1)
        end = min(rise + bent_low + (bent_high - bent_low) * height, _STEEPEST)
        heading = direction_of(azimuth, 0.5 * (rise + end))
        length = max(0.85 * form.outline.room(origin, heading), 0.08) * rng.uniform(0.85, 1.0)
        axis = grow_axis(origin, azimuth, (rise, end), length, 8, rng, wander=form.wander)
        limb = self.skeleton.add(axis, trunk, at)
        roll = rng.uniform(0.0, np.pi)
        nodes = np.linspace(2.0, 8.0, form.n_branches).round().astype(int)
        for i, node in enumerate(nodes.tolist()):
            side = roll + _turn_of(i, form.is_opposite) + rng.uniform(-0.3, 0.3)
            angle = form.spread * rng.uniform(0.8, 1.2)
            tangent = self.skeleton.shoots[limb].tangent(node)
            self._add_branch(limb, node, aim(tangent, angle, side))

    def _add_branch(self, limb: int, at: int, heading: Floats) -> None:
        """Add a branch of a limb with its twigs in a flat spray."""
        form = self.form
        rng = self.rng
        origin = self.skeleton.shoots[limb].nodes[at]
        azimuth, rise = heading_of(heading)
        longest = 0.55 * form.outline.half_width
        length = float(np.clip(0.85 * form.outline.room(origin, heading), 0.06, longest))
        length *= rng.uniform(0.8, 1.0)
        ends = rise, float(np.clip(rise + form.branch_turn, -1.3, _STEEPEST))
        n_segments = 6 if length > 0.1 else 4
        axis = grow_axis(
            origin, azimuth, ends, length, n_segments, rng, wander=1.2 * form.wander, floor=0.03
        )
        branch = self.skeleton.add(axis, limb, at)
        sides = 0.2, np.pi - 0.2
        add_twigs(self.skeleton, branch, form.twig, 0.75, sides, first_node=2, lift=form.lift)


def _turn_of(i: int, is_opposite: bool) -> float:
    """Azimuth about a shoot of its i-th side shoot in [rad]: in a spiral, or in crossed pairs."""
    return float((i % 2 + i // 2 * 0.5) * np.pi) if is_opposite else float(i * GOLDEN_ANGLE)
