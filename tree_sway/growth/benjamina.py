# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
*Ficus benjamina*, the weeping fig, as a pot plant: the first of the paper's two plants (3.1).

Several slender stems from a short stock, upright and leaning apart; branches that rise, arch over
and hang; thin pendulous twigs, left and right in turn.
"""

from __future__ import annotations

import numpy as np

from tree_sway.core.tree import Tree
from tree_sway.growth.axis import aim, GOLDEN_ANGLE, grow_axis, heading_of
from tree_sway.growth.skeleton import Skeleton
from tree_sway.growth.thickness import finished_tree
from tree_sway.growth.twigs import add_twigs

_N_STEMS = 5
_UPRIGHT = np.pi / 2.0
_N_NODES = 10
_BRANCHING = (3, 4, 5, 5, 6, 7, 7, 8, 9, 9, 10, 10)
"""Node of a stem that each of its branches grows from."""

_SIDES = (0.15, np.pi - 0.15)
"""Azimuths of twigs about their branch, right and left in turn, in [rad]."""


def grow_benjamina(
    rng: np.random.Generator,
    height: float = 1.3,
    diameter: float = 0.0235,
    species: str = 'benjamina',
) -> Tree:
    """Grow a weeping pot plant with several stems; the diameter is the stock's at its base."""
    skeleton = Skeleton()

    def add_stem(at: int, azimuth: float, lean: float) -> None:
        """Add one stem with its branches; lean 0 is the leader, which stays upright longest."""
        at_foot = _UPRIGHT - lean * rng.uniform(0.18, 0.30)
        at_top = _UPRIGHT - lean * rng.uniform(0.1, 0.35)
        length = rng.uniform(0.78, 1.0) if lean else 1.02
        origin = skeleton.shoots[stock].nodes[at]
        elevations = (at_foot, at_top)
        nodes = grow_axis(origin, azimuth, elevations, length, _N_NODES, rng, wander=0.03)
        stem = skeleton.add(nodes, stock, at)
        roll = rng.uniform(0.0, 2.0 * np.pi)
        for i, node in enumerate(_BRANCHING):
            # Branches shorten to the top; away from the middle of the plant there is light.
            full_length = 0.50 * (1.0 - 0.6 * (node / _N_NODES))
            length = full_length * rng.uniform(0.8, 1.2)
            angle = rng.uniform(0.5, 0.9)
            along = skeleton.shoots[stem].tangent(node)
            direction = aim(along, angle, roll + i * GOLDEN_ANGLE)
            outward = nodes[node] * np.array([1.0, 1.0, 0.0])
            add_branch(stem, node, heading_of(direction + 1.5 * outward), length)

    def add_branch(stem: int, at: int, heading: tuple[float, float], length: float) -> None:
        """Add a branch that rises, arches over and hangs, with its twigs."""
        azimuth, elevation = heading
        elevations = (min(elevation, 1.0), rng.uniform(-1.35, -1.0))
        origin = skeleton.shoots[stem].nodes[at]
        n_segments = 6 if length > 0.2 else 5
        nodes = grow_axis(
            origin, azimuth, elevations, length, n_segments, rng, wander=0.06, floor=0.12
        )
        branch = skeleton.add(nodes, stem, at)
        twig_length = 0.06 + 0.1 * length
        add_twigs(skeleton, branch, twig_length, 0.7, _SIDES, first_node=2, lift=-0.75)

    stock = skeleton.add(grow_axis(np.zeros(3), 0.0, (_UPRIGHT, _UPRIGHT), 0.07, 2, rng))
    facing = rng.uniform(0.0, 2.0 * np.pi)
    for i in range(_N_STEMS):
        azimuth = facing + 2.0 * np.pi * i / _N_STEMS + rng.uniform(-0.3, 0.3)
        add_stem(2 if i else 1, azimuth, 0.0 if i == 2 else 1.0)
    return finished_tree(skeleton, height, diameter, species, pot=0.0012 / 1.3, exponent=2.5)
