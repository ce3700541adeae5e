# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Twigs: shoots of a single segment, in groups that are alike.

Neighbours on the same side of a branch have the same direction and length, so that a solver that
computes one of them may reuse its motion for the others (Kanda & Ohya, 3.3). Each half of the
parent has its own length and direction, as the parent bends.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tree_sway.growth.axis import aim, UP
from tree_sway.growth.skeleton import Skeleton


def add_twigs(
    skeleton: Skeleton, shoot: int, length: float, polar: float, sides: Sequence[float], *,
    first_node: int = 1, lift: float = 0.0, outer_ratio: float = 0.75,
) -> None:  # fmt: skip
    """
    Add twigs on the nodes of a shoot, from a first node on.

    Parameters
    ----------
    skeleton, shoot, first_node
        Shoots, number of this shoot, and its first node with twigs.
    length, outer_ratio
        Length of the twigs on the inner half in [m], and its ratio on the outer half [-].
    polar
        Angle from the shoot in [rad].
    sides
        Angles about the shoot in [rad], as in `aim`: two for a flat spray.
    lift
        Bend of the twigs upwards (positive) or downwards (negative), in [-]; 1 is half-way.

    """
    parent = skeleton.shoots[shoot]
    last = parent.n_segments
    middle = (last + 1) // 2
    halves = ((0, middle, 1.0), (middle, last, outer_ratio))
    for start, stop, ratio in halves:
        if start == stop:
            continue
        along = parent.nodes[stop] - parent.nodes[start]
        along = along / np.linalg.norm(along)
        offsets = []
        for side in sides:
            heading = aim(along, polar, side) + lift * UP
            offsets.append(ratio * length / np.linalg.norm(heading) * heading)
        for node in range(max(start + 1, first_node), stop + 1):
            base = parent.nodes[node]
            for offset in offsets:
                skeleton.add(np.stack([base, base + offset]), shoot, node)
