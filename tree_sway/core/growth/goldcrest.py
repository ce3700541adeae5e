# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
*Cupressus macrocarpa* 'Goldcrest' as a pot plant: the second of the paper's two plants (3.1).

One straight stem; many short branches close together, steeply ascending, that shorten to the top,
so that the whole is a narrow cone; short twigs all round them.
"""

from __future__ import annotations

import numpy as np

from tree_sway.core.growth.axis import GOLDEN_ANGLE, grow_axis
from tree_sway.core.growth.skeleton import Skeleton
from tree_sway.core.growth.thickness import finished_tree
from tree_sway.core.growth.twigs import add_twigs
from tree_sway.core.tree.tree import Tree

_UPRIGHT = np.pi / 2.0
_N_NODES = 28


def grow_goldcrest(
    rng: np.random.Generator,
    height: float = 1.2,
    diameter: float = 0.019,
    species: str = 'goldcrest',
) -> Tree:
    """Grow a narrow cone of steep short branches; the diameter is that of the stem at its base."""
    skeleton, upright = Skeleton(), (_UPRIGHT, _UPRIGHT)

    def add_branch(at: int, azimuth: float, here: float) -> None:
        """Add a branch at a relative height of the stem, reaching for the surface of the cone."""
        length = (0.26 * (1.0 - here) + 0.03) * rng.uniform(0.88, 1.08)
        # The lowest are the longest, below the others; all turn up at the end.
        spread = rng.uniform(0.55, 0.75) + 0.3 * max(0.0, 1.0 - 4.0 * here)
        ends = (_UPRIGHT - spread, _UPRIGHT - 0.3 * spread)
        segments = 6 if here < 0.6 else 4 if here < 0.85 else 3
        origin = skeleton.shoots[stem].nodes[at]
        axis = grow_axis(origin, azimuth, ends, length, segments, rng, wander=0.04)
        branch, roll = skeleton.add(axis, stem, at), rng.uniform(0.0, np.pi)
        sides, twig = (roll, roll + np.pi), 0.03 + 0.08 * length
        add_twigs(skeleton, branch, twig, 0.6, sides, first_node=2, lift=0.25)

    stem = skeleton.add(grow_axis(np.zeros(3), 0.0, upright, 1.0, _N_NODES, rng, wander=0.006))
    roll = rng.uniform(0.0, 2.0 * np.pi)
    for node in range(1, _N_NODES - 1):
        here = node / _N_NODES
        for turn in range(3 if here < 0.75 else 2):
            add_branch(node, roll + (3 * node + turn) * GOLDEN_ANGLE, here)
    return finished_tree(skeleton, height, diameter, species, pot=0.001 / 1.2, exponent=2.2)
