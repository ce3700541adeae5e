# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A conifer that stands alone: one straight stem, branches in whorls, a pointed crown.

Branches near the ground are the oldest: long, level or hanging, their ends turned up. Those near
the top are short and point upwards. Twigs stand left and right of each branch in a flat spray.

"""

from __future__ import annotations

import numpy as np

from tree_sway_ros.core.growth.axis import grow_axis
from tree_sway_ros.core.growth.skeleton import Skeleton
from tree_sway_ros.core.growth.thickness import BREAST_HEIGHT, node_diameters
from tree_sway_ros.core.growth.twigs import add_twigs
from tree_sway_ros.core.tree.tree import Tree

_UPRIGHT = np.pi / 2.0
_N_NODES = 24
_WHORL = 5


def grow_conifer(
    rng: np.random.Generator,
    *,
    height: float = 12.0,
    diameter: float = 0.2,
    crown_base: float = 0.1,
    name: str = "conifer",
    species: str = "spruce",
) -> Tree:
    """
    Grow a pointed crown of whorls on a straight stem.

    Parameters
    ----------
    rng
        Source of randomness; the same state gives the same tree.
    height
        Height in [m].
    diameter
        Diameter in [m] at breast height, or at the base of a tree below twice that height.
    crown_base
        Height of the lowest whorl over that of the tree in [-].
    name, species
        What the tree is called, and the key of its wood.

    """
    skeleton = Skeleton()
    stem = skeleton.add(
        grow_axis(
            np.zeros(3), 0.0, (_UPRIGHT, _UPRIGHT), 1.0, _N_NODES, rng, wander=0.006, unevenness=0.1
        )
    )
    for node in range(max(1, round(crown_base * _N_NODES)), _N_NODES):
        here = (node / _N_NODES - crown_base) / (1.0 - crown_base)
        whorl = _WHORL if here < 0.8 else _WHORL - 1
        roll = rng.uniform(0.0, 2.0 * np.pi)
        for turn in range(whorl):
            azimuth = roll + 2.0 * np.pi * turn / whorl + rng.uniform(-0.2, 0.2)
            _add_branch(skeleton, stem, node, azimuth, max(here, 0.0), rng)
    skeleton.scale_to_height(height)
    at_height = BREAST_HEIGHT if height > 2.0 * BREAST_HEIGHT else 0.0
    diameters = node_diameters(
        skeleton, diameter, at_height=at_height, tip_diameter=0.003 * (height / 8.0) ** 0.5
    )
    return skeleton.to_tree(diameters, name, species)


def _add_branch(
    skeleton: Skeleton,
    stem: int,
    at: int,
    azimuth: float,
    here: float,
    rng: np.random.Generator,
) -> None:
    """Add a branch at a relative height of the crown, reaching for the surface of the cone."""
    length = (0.2 * (1.0 - here) ** 0.85 + 0.012) * rng.uniform(0.85, 1.08)
    first = -0.15 + 0.95 * here + rng.uniform(-0.08, 0.08)
    n_segments = 6 if here < 0.7 else 4 if here < 0.9 else 2
    origin = skeleton.shoots[stem].nodes[at]
    nodes = grow_axis(
        origin, azimuth, (first, first + 0.35), length, n_segments, rng, wander=0.05, floor=0.01
    )
    branch = skeleton.add(nodes, stem, at)
    if n_segments > 2:
        add_twigs(
            skeleton,
            branch,
            length=0.012 + 0.22 * length,
            polar=0.85,
            sides=(0.0, np.pi),
            first_node=2,
            outer_ratio=0.65,
        )
