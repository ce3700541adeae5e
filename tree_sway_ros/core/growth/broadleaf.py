# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A broadleaf that stands alone: a trunk lost in its limbs, and a crown of its species' form.

Limbs and their branches grow towards the outline of the crown and stop short of it; that alone
shapes it.
"""

from __future__ import annotations

import numpy as np

from tree_sway_ros.core.arrays import Floats
from tree_sway_ros.core.growth.axis import aim, direction_of, GOLDEN_ANGLE, grow_axis, heading_of
from tree_sway_ros.core.growth.forms import broadleaf_form, BroadleafForm
from tree_sway_ros.core.growth.skeleton import Skeleton
from tree_sway_ros.core.growth.thickness import BREAST_HEIGHT, node_diameters
from tree_sway_ros.core.growth.twigs import add_twigs
from tree_sway_ros.core.tree.tree import Tree

_N_NODES = 12


def grow_broadleaf(
    rng: np.random.Generator,
    *,
    height: float = 8.0,
    diameter: float = 0.18,
    name: str = 'broadleaf',
    species: str = 'broadleaf',
) -> Tree:
    """
    Grow a tree with a trunk, limbs, branches and twigs, of a height and a diameter in [m].

    The diameter is at breast height, or at the base of a tree below twice that height. The same
    state of the source of randomness gives the same tree.
    """
    form, skeleton = broadleaf_form(species), Skeleton()
    facing = rng.uniform(0.0, 2.0 * np.pi)
    trunk = skeleton.add(
        grow_axis(
            np.zeros(3), facing, (1.57, 1.47), form.trunk, _N_NODES, rng, wander=0.6 * form.wander
        )
    )
    lowest = max(1, round(form.bole / form.trunk * _N_NODES))
    nodes = np.linspace(lowest, _N_NODES, form.n_limbs).round().astype(int)
    if form.is_opposite:
        nodes = nodes[np.arange(form.n_limbs) // 2 * 2]
    roll = rng.uniform(0.0, 2.0 * np.pi)
    for i, node in enumerate(nodes.tolist()):
        azimuth = roll + _turn_of(i, form.is_opposite) + rng.uniform(-0.15, 0.15)
        here = (node - lowest) / (_N_NODES - lowest)
        _add_limb(skeleton, trunk, node, azimuth, here, form, rng)
    skeleton.scale_to_height(height)
    at_height = BREAST_HEIGHT if height > 2.0 * BREAST_HEIGHT else 0.0
    diameters = node_diameters(
        skeleton,
        diameter,
        at_height=at_height,
        tip_diameter=0.003 * (height / 8.0) ** 0.5,
        exponent=form.exponent,
        bole_taper=form.taper,
    )
    return skeleton.to_tree(diameters, name, species)


def _turn_of(i: int, is_opposite: bool) -> float:
    """Azimuth about a shoot of its i-th side shoot in [rad]: in a spiral, or in crossed pairs."""
    return float((i % 2 + i // 2 * 0.5) * np.pi) if is_opposite else float(i * GOLDEN_ANGLE)


def _add_limb(
    skeleton: Skeleton,
    trunk: int,
    at: int,
    azimuth: float,
    here: float,
    form: BroadleafForm,
    rng: np.random.Generator,
) -> None:
    """Add a limb at a height of the trunk, from 0 at the lowest limb to 1, with its branches."""
    origin = skeleton.shoots[trunk].nodes[at]
    (low, high), (bent_low, bent_high) = form.rise, form.turn
    rise = low + (high - low) * here + rng.uniform(-0.1, 0.1)
    end = min(rise + bent_low + (bent_high - bent_low) * here, 1.4)
    heading = direction_of(azimuth, 0.5 * (rise + end))
    length = max(0.85 * form.outline.reach(origin, heading), 0.08) * rng.uniform(0.85, 1.0)
    axis = grow_axis(origin, azimuth, (rise, end), length, 8, rng, wander=form.wander)
    limb = skeleton.add(axis, trunk, at)
    roll = rng.uniform(0.0, np.pi)
    for i, node in enumerate(np.linspace(2.0, 8.0, form.n_branches).round().astype(int).tolist()):
        side = roll + _turn_of(i, form.is_opposite) + rng.uniform(-0.3, 0.3)
        angle = form.spread * rng.uniform(0.8, 1.2)
        heading = aim(skeleton.shoots[limb].tangent(node), angle, side)
        _add_branch(skeleton, limb, node, heading, form, rng)


def _add_branch(
    skeleton: Skeleton,
    limb: int,
    at: int,
    heading: Floats,
    form: BroadleafForm,
    rng: np.random.Generator,
) -> None:
    """Add a branch of a limb with its twigs in a flat spray."""
    origin = skeleton.shoots[limb].nodes[at]
    azimuth, rise = heading_of(heading)
    longest = 0.55 * form.outline.half_width
    length = float(np.clip(0.85 * form.outline.reach(origin, heading), 0.06, longest))
    length *= rng.uniform(0.8, 1.0)
    end = float(np.clip(rise + form.branch_turn, -1.3, 1.4))
    n_segments = 6 if length > 0.1 else 4
    axis = grow_axis(
        origin, azimuth, (rise, end), length, n_segments, rng, wander=1.2 * form.wander, floor=0.03
    )
    branch = skeleton.add(axis, limb, at)
    add_twigs(
        skeleton,
        branch,
        length=form.twig,
        polar=0.75,
        sides=(0.2, np.pi - 0.2),
        first_node=2,
        lift=form.lift,
    )
