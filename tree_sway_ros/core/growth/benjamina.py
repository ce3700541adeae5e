# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
*Ficus benjamina*, the weeping fig, as a pot plant: the first of the paper's two plants (3.1).

Several slender stems from a short stock, upright and leaning apart; branches that rise, arch over
and hang; thin pendulous twigs, left and right in turn.
"""

from __future__ import annotations

import numpy as np

from tree_sway_ros.core.growth.axis import aim, GOLDEN_ANGLE, grow_axis, heading_of
from tree_sway_ros.core.growth.skeleton import Skeleton
from tree_sway_ros.core.growth.thickness import node_diameters
from tree_sway_ros.core.growth.twigs import add_twigs
from tree_sway_ros.core.tree.tree import Tree

N_STEMS = 5
_UPRIGHT = np.pi / 2.0


def grow_benjamina(
    rng: np.random.Generator,
    *,
    height: float = 1.3,
    diameter: float = 0.0235,
    name: str = 'benjamina',
    species: str = 'benjamina',
) -> Tree:
    """Grow a weeping pot plant with several stems; the diameter is the stock's at its base."""
    skeleton = Skeleton()
    stock = skeleton.add(grow_axis(np.zeros(3), 0.0, (_UPRIGHT, _UPRIGHT), 0.07, 2, rng))
    facing = rng.uniform(0.0, 2.0 * np.pi)
    for i in range(N_STEMS):
        azimuth = facing + 2.0 * np.pi * i / N_STEMS + rng.uniform(-0.3, 0.3)
        _add_stem(skeleton, stock, 2 if i else 1, azimuth, 0.0 if i == 2 else 1.0, rng)
    skeleton.scale_to_height(height)
    diameters = node_diameters(
        skeleton, diameter, at_height=0.0, tip_diameter=0.0012 * height / 1.3, exponent=2.5
    )
    return skeleton.to_tree(diameters, name, species)


def _add_stem(
    skeleton: Skeleton, stock: int, at: int, azimuth: float, lean: float, rng: np.random.Generator
) -> None:
    """Add one stem with its branches; lean 0 is the leader, which stays upright longest."""
    elevation = (
        _UPRIGHT - lean * rng.uniform(0.18, 0.30),
        _UPRIGHT - lean * rng.uniform(0.1, 0.35),
    )
    length = rng.uniform(0.78, 1.0) if lean else 1.02
    n_nodes = 10
    nodes = grow_axis(
        skeleton.shoots[stock].nodes[at], azimuth, elevation, length, n_nodes, rng, wander=0.03
    )
    stem = skeleton.add(nodes, stock, at)
    roll = rng.uniform(0.0, 2.0 * np.pi)
    for i, node in enumerate((3, 4, 5, 5, 6, 7, 7, 8, 9, 9, 10, 10)):
        here = node / n_nodes
        # Branches shorten to the top; away from the middle of the plant there is light.
        reach = 0.50 * (1.0 - 0.6 * here) * rng.uniform(0.8, 1.2)
        heading = aim(
            skeleton.shoots[stem].tangent(node), rng.uniform(0.5, 0.9), roll + i * GOLDEN_ANGLE
        )
        heading = heading + 1.5 * nodes[node] * np.array([1.0, 1.0, 0.0])
        _add_branch(skeleton, stem, node, heading_of(heading), reach, rng)


def _add_branch(
    skeleton: Skeleton,
    stem: int,
    at: int,
    heading: tuple[float, float],
    length: float,
    rng: np.random.Generator,
) -> None:
    """Add a branch that rises, arches over and hangs, with its twigs."""
    azimuth, rise = heading
    droop = rng.uniform(-1.35, -1.0)
    origin = skeleton.shoots[stem].nodes[at]
    nodes = grow_axis(
        origin,
        azimuth,
        (min(rise, 1.0), droop),
        length,
        6 if length > 0.2 else 5,
        rng,
        wander=0.06,
        floor=0.12,
    )
    branch = skeleton.add(nodes, stem, at)
    add_twigs(
        skeleton,
        branch,
        length=0.06 + 0.1 * length,
        polar=0.7,
        sides=(0.15, np.pi - 0.15),
        first_node=2,
        lift=-0.75,
    )
