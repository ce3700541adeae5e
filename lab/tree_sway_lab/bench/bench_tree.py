# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The tree that the benchmarks run on: 121 branches of 6 segments, four orders, made by rule.

A stem of 6 m carries twelve branches of 2.2 m, each of those three of 0.9 m, each of those two of
0.4 m; diameters go from 120 mm at the ground to 8 mm at the last tips. Azimuths follow the golden
angle, so that no two branches are alike.

"""

from __future__ import annotations

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.tree import Tree, tree_from_segments

SEGMENTS_A_BRANCH = 6
_GOLDEN_ANGLE = np.pi * (3.0 - np.sqrt(5.0))
_LENGTH = (6.0, 2.2, 0.9, 0.4)
_DIAMETER = ((0.120, 0.044), (0.044, 0.022), (0.022, 0.013), (0.013, 0.008))
_CHILDREN = (12, 3, 2)
#: Angle between a child and its parent, by the child's order.
_INSERTION = (0.0, np.radians(55.0), np.radians(50.0), np.radians(45.0))


def bench_tree(
    segments_a_branch: int = SEGMENTS_A_BRANCH,
    children: tuple[int, ...] = _CHILDREN,
    *,
    bears: bool = False,
) -> Tree:
    """
    Build the benchmark tree.

    Parameters
    ----------
    segments_a_branch
        How finely each branch is cut; its shape stays the same.
    children
        How many branches sit on one of each order, but the last.
    bears
        Whether branches that carry more are thicker, so that their section grows as that of all
        they carry (da Vinci's rule), and longer, by the power 2/3 of the thickness (elastic
        similarity: McMahon & Kronauer, 1976). Else a tree of more branches is ever more slender.

    Returns
    -------
    Tree
        With 121 branches, of ``121 * segments_a_branch`` segments, if nothing else is given for
        its children.

    """
    start: list[Floats] = []
    end: list[Floats] = []
    diameter: list[Floats] = []
    parent: list[int] = []
    branch: list[int] = []
    cuts = np.linspace(0.0, 1.0, segments_a_branch + 1)
    thicker = np.ones(len(_LENGTH) + 1)
    if bears:
        for order in range(len(children) - 1, -1, -1):
            more = children[order] / _CHILDREN[order]
            thicker[order] = thicker[order + 1] * np.sqrt(more)
    # Base, direction, order and the segment it sits on, of the branches that are still to be
    # built.
    waiting = [(np.zeros(3), np.array([0.0, 0.0, 1.0]), 0, -1)]
    for number, (base, direction, order, carrying) in enumerate(waiting):
        length = thicker[order] ** (2.0 / 3.0) * _LENGTH[order]
        nodes = base + np.outer(cuts, length * direction)
        thick = np.interp(cuts, [0.0, 1.0], thicker[order : order + 2] * _DIAMETER[order])
        first = len(parent)
        start += list(nodes[:-1])
        end += list(nodes[1:])
        diameter += list(np.stack([thick[:-1], thick[1:]], axis=1))
        parent += [carrying, *range(first, first + segments_a_branch - 1)]
        branch += [number] * segments_a_branch
        if order == len(children):
            continue
        for child in range(children[order]):
            # Children sit on nodes of the upper two thirds, the last ones at the tip.
            place = segments_a_branch * (2 + 4 * (child + 1) / children[order]) / 6
            node = max(1, int(place))
            heading = _GOLDEN_ANGLE * (len(waiting) + 1)
            turned = _tilted(direction, _INSERTION[order + 1], heading)
            waiting.append((nodes[node], turned, order + 1, first + node - 1))
    return tree_from_segments(
        np.array(start),
        np.array(end),
        np.array(diameter),
        parent=np.array(parent),
        branch=np.array(branch),
        name=f'bench{len(waiting)}',
    )


def _tilted(axis: Floats, angle: float, heading: float) -> Floats:
    """Turn a unit vector by an angle away from itself, towards a heading around itself."""
    reference = np.array([1.0, 0.0, 0.0]) if abs(axis[2]) > 0.9 else np.array([0.0, 0.0, 1.0])
    side = np.cross(axis, reference)
    side /= np.linalg.norm(side)
    other = np.cross(axis, side)
    out = np.cos(heading) * side + np.sin(heading) * other
    return np.asarray(np.cos(angle) * axis + np.sin(angle) * out)
