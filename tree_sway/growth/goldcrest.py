# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
*Cupressus macrocarpa* 'Goldcrest' as a pot plant: the second of the paper's two plants (3.1).

One straight stem; many short branches close together, steeply ascending, that shorten to the top,
so that the whole is a narrow cone; short twigs all round them.
"""

from __future__ import annotations

import numpy as np

from tree_sway.core.tree import Tree
from tree_sway.growth.axis import GOLDEN_ANGLE, grow_axis
from tree_sway.growth.skeleton import Skeleton
from tree_sway.growth.thickness import finished_tree
from tree_sway.growth.twigs import add_twigs

_UPRIGHT = np.pi / 2.0
_N_NODES = 28


def grow_goldcrest(
    rng: np.random.Generator,
    height: float = 1.2,
    diameter: float = 0.019,
    species: str = 'goldcrest',
) -> Tree:
    """Grow a narrow cone of steep short branches; the diameter is that of the stem at its base."""
    skeleton = Skeleton()

    def add_branch(at: int, azimuth: float, here: float) -> None:
        """Add a branch at a relative height of the stem, reaching for the surface of the cone."""
        length = (0.26 * (1.0 - here) + 0.03) * rng.uniform(0.88, 1.08)
        # The lowest are the longest, below the others; all turn up at the end.
        spread = rng.uniform(0.55, 0.75) + 0.3 * max(0.0, 1.0 - 4.0 * here)
        elevations = (_UPRIGHT - spread, _UPRIGHT - 0.3 * spread)
        n_segments = 3
        if here < 0.6:
            n_segments = 6
        elif here < 0.85:
            n_segments = 4
        origin = skeleton.shoots[stem].nodes[at]
        nodes = grow_axis(origin, azimuth, elevations, length, n_segments, rng, wander=0.04)
        branch = skeleton.add(nodes, stem, at)
        roll = rng.uniform(0.0, np.pi)
        sides = (roll, roll + np.pi)
        twig_length = 0.03 + 0.08 * length
        add_twigs(skeleton, branch, twig_length, 0.6, sides, first_node=2, lift=0.25)

    stem = skeleton.add(
        grow_axis(np.zeros(3), 0.0, (_UPRIGHT, _UPRIGHT), 1.0, _N_NODES, rng, wander=0.006)
    )
    roll = rng.uniform(0.0, 2.0 * np.pi)
    for node in range(1, _N_NODES - 1):
        here = node / _N_NODES
        for turn in range(3 if here < 0.75 else 2):
            add_branch(node, roll + (3 * node + turn) * GOLDEN_ANGLE, here)
    return finished_tree(skeleton, height, diameter, species, pot=0.001 / 1.2, exponent=2.2)
