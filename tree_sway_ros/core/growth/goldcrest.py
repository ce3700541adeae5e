# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
*Cupressus macrocarpa* 'Goldcrest' as a pot plant: the second of the paper's two plants (3.1).

One straight stem; many short branches close together, steeply ascending, that shorten to the top,
so that the whole is a narrow cone; short twigs all round them.
"""

from __future__ import annotations

import numpy as np

from tree_sway_ros.core.growth.axis import GOLDEN_ANGLE, grow_axis
from tree_sway_ros.core.growth.skeleton import Skeleton
from tree_sway_ros.core.growth.thickness import node_diameters
from tree_sway_ros.core.growth.twigs import add_twigs
from tree_sway_ros.core.tree.tree import Tree

_UPRIGHT = np.pi / 2.0


def grow_goldcrest(
    rng: np.random.Generator,
    *,
    height: float = 1.2,
    diameter: float = 0.019,
    name: str = 'goldcrest',
    species: str = 'goldcrest',
) -> Tree:
    """Grow a narrow cone of steep short branches; the diameter is that of the stem at its base."""
    skeleton = Skeleton()
    n_nodes = 28
    stem = skeleton.add(
        grow_axis(np.zeros(3), 0.0, (_UPRIGHT, _UPRIGHT), 1.0, n_nodes, rng, wander=0.006)
    )
    roll = rng.uniform(0.0, 2.0 * np.pi)
    for node in range(1, n_nodes - 1):
        here = node / n_nodes
        for turn in range(3 if here < 0.75 else 2):
            azimuth = roll + (3 * node + turn) * GOLDEN_ANGLE
            _add_branch(skeleton, stem, node, azimuth, here, rng)
    skeleton.scale_to_height(height)
    diameters = node_diameters(
        skeleton, diameter, at_height=0.0, tip_diameter=0.001 * height / 1.2, exponent=2.2
    )
    return skeleton.to_tree(diameters, name, species)


def _add_branch(
    skeleton: Skeleton, stem: int, at: int, azimuth: float, here: float, rng: np.random.Generator
) -> None:
    """Add a branch at a relative height of the stem, reaching for the surface of the cone."""
    length = (0.26 * (1.0 - here) + 0.03) * rng.uniform(0.88, 1.08)
    # The lowest reach out to be under the others; all turn up at the end.
    spread = rng.uniform(0.55, 0.75) + 0.3 * max(0.0, 1.0 - 4.0 * here)
    elevation = (_UPRIGHT - spread, _UPRIGHT - 0.3 * spread)
    n_segments = 6 if here < 0.6 else 4 if here < 0.85 else 3
    origin = skeleton.shoots[stem].nodes[at]
    nodes = grow_axis(origin, azimuth, elevation, length, n_segments, rng, wander=0.04)
    branch = skeleton.add(nodes, stem, at)
    roll = rng.uniform(0.0, np.pi)
    add_twigs(
        skeleton,
        branch,
        length=0.03 + 0.08 * length,
        polar=0.6,
        sides=(roll, roll + np.pi),
        first_node=2,
        lift=0.25,
    )
