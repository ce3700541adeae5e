# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Trees to measure on: three of 40 branches, one of 121, and plain stems, made by formulas.

How a tree sways is decided by how children compare with their parent. A child of length ratio l
and diameter ratio d has d / l^2 times its parent's frequency: near 1 they swing together, and
coupling is strongest.

"""

from __future__ import annotations

import itertools
import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.core.arrays import Floats, Ints
from tree_sway.core.tree import Tree, tree_from_segments

RATIOS: tuple[tuple[float, float], ...] = ((0.65, 0.6), (0.5, 0.6), (0.4, 0.35))
"""Length and diameter of a child over its parent's: long twigs, stiff twigs, light twigs."""

EXAMPLE_MODULUS, EXAMPLE_DENSITY = 8.0e9, 900.0
"""Young's modulus in [Pa] and density in [kg/m^3] that go with these trees."""

_GOLDEN_ANGLE = math.pi * (3.0 - math.sqrt(5.0))


def forked_tree(
    length_ratio: float, diameter_ratio: float, *, segments: int = 6, generations: int = 4
) -> Tree:
    """
    Make a tree of 1 + 3 + 9 + 27 branches in 3D, or of another number of generations.

    Every branch but the last bears three, at 1/2, 2/3 and 5/6 of its length, and tapers to two
    fifths.

    Parameters
    ----------
    length_ratio, diameter_ratio
        Length and diameter of a child over those of its parent.
    segments
        Segments per branch, a multiple of 6.
    generations
        How many there are, the stem's being the first.

    Returns
    -------
    Tree
        A stem of 6 m, 12 cm thick at its base.

    """
    thirds = (1 / 2, 2 / 3, 5 / 6)
    orders = [
        _Order(6.0 * length_ratio**k, 0.12 * diameter_ratio**k, 0.048 * diameter_ratio**k, thirds)
        for k in range(generations)
    ]
    return _grown(orders, segments, 50.0, f'forked {length_ratio:g} {diameter_ratio:g}')


def broom_tree(*, segments: int = 6) -> Tree:
    """
    Make a tree of 1 + 12 + 36 + 72 branches: 6, 2.2, 0.9 and 0.4 m long, radii from 60 to 4 mm.

    Parameters
    ----------
    segments
        Segments per branch, a multiple of 6.

    """
    on_stem = (2, 2, 3, 3, 3, 4, 4, 5, 5, 5, 6, 6)
    orders = [
        _Order(6.0, 0.12, 0.044, tuple(k / 6 for k in on_stem)),
        _Order(2.2, 0.044, 0.022, (1 / 3, 2 / 3, 1.0)),
        _Order(0.9, 0.022, 0.013, (1 / 2, 5 / 6)),
        _Order(0.4, 0.013, 0.008, ()),
    ]
    return _grown(orders, segments, 56.0, 'broom')


def tapered_stem(
    length: float, diameter: ArrayLike, *, direction: tuple[float, float, float] = (0.0, 0.0, 1.0)
) -> Tree:
    """
    Make a straight stem of one branch.

    Parameters
    ----------
    length
        In [m].
    diameter
        At equally spaced nodes in [m], one more than segments.
    direction
        Unit vector it grows along.

    """
    widths = np.asarray(diameter, dtype=np.float64)
    nodes = np.linspace(0.0, length, len(widths))[:, None] * np.asarray(direction)
    pair = np.stack([widths[:-1], widths[1:]], axis=1)
    parent = np.arange(-1, len(widths) - 2)
    return tree_from_segments(nodes[:-1], nodes[1:], pair, parent=parent, name='stem')


class _Order(NamedTuple):
    """Branches of one order: length, diameters at base and tip, and where their children sit."""

    length: float
    base: float
    tip: float
    children: tuple[float, ...]


def _grown(orders: list[_Order], segments: int, angle: float, name: str) -> Tree:
    """Grow straight branches, each turned by a golden angle, at an angle off in [deg]."""
    place = np.linspace(0.0, 1.0, segments + 1)
    shoots = [(np.zeros(3), np.array([0.0, 0.0, 1.0]), 0, -1)]
    turns = 0
    for index, (base, direction, order, _) in enumerate(shoots):
        if order + 1 < len(orders):
            for along in orders[order].children:
                turns += 1
                node = round(along * segments)
                carrying = base + node / segments * orders[order].length * direction
                way = _aside(direction, math.radians(angle), turns * _GOLDEN_ANGLE)
                shoots.append((carrying, way, order + 1, segments * index + node - 1))
    start: list[Floats] = []
    end: list[Floats] = []
    width: list[Floats] = []
    parent: list[Ints] = []
    for base, direction, order, seat_segment in shoots:
        kind = orders[order]
        nodes = base + place[:, None] * kind.length * direction
        widths = kind.base + place * (kind.tip - kind.base)
        start.append(nodes[:-1])
        end.append(nodes[1:])
        width.append(np.stack([widths[:-1], widths[1:]], axis=1))
        first = segments * len(parent)
        parent.append(np.array([seat_segment, *range(first, first + segments - 1)]))
    return tree_from_segments(
        np.concatenate(start),
        np.concatenate(end),
        np.concatenate(width),
        parent=np.concatenate(parent),
        branch=np.repeat(np.arange(len(shoots)), segments),
        name=name,
    )


def _aside(direction: Floats, angle: float, azimuth: float) -> Floats:
    other = np.array([1.0, 0.0, 0.0]) if abs(direction[0]) < 0.9 else np.array([0.0, 1.0, 0.0])
    first = np.cross(direction, other)
    first /= np.linalg.norm(first)
    second = np.cross(direction, first)
    round_it = math.cos(azimuth) * first + math.sin(azimuth) * second
    out: Floats = math.cos(angle) * direction + math.sin(angle) * round_it
    return out


def branch_order(tree: Tree) -> Ints:
    """Branching order: 0 for the stem, one more than its parent's for the others, (b,)."""
    order = np.zeros(tree.n_branches, dtype=np.int64)
    for branch in np.flatnonzero(tree.branch_parent >= 0):
        order[branch] = order[tree.branch_parent[branch]] + 1
    return order


def leafy_sapling(wander: float = 0.0, seed: int = 0) -> Tree:
    """
    Return a stem of 1.6 m with twelve petioles of 9 cm by 1.8 mm, each for a leaf.

    Parameters
    ----------
    wander
        Step [m] by which the stem leaves the vertical from one segment to the next.
    seed
        Seed of its random numbers.

    """
    rng = np.random.default_rng(seed)
    nodes = np.zeros((13, 3))
    nodes[:, 2] = 1.6 * np.arange(13) / 12.0
    nodes[1:, :2] = np.cumsum(wander * rng.normal(size=(12, 2)), axis=0)
    thickness = np.interp(nodes[:, 2], [0.0, 1.6], [0.012, 0.004])
    start, end = list(nodes[:-1]), list(nodes[1:])
    diameter = list(itertools.pairwise(thickness))
    parent, branch = list(range(-1, 11)), [0] * 12
    for leaf in range(12):
        turn = 2.4 * leaf + 40.0 * wander * rng.normal()  # about the golden angle
        away = np.array([np.cos(turn), np.sin(turn), 0.5])
        away *= 0.03 / np.linalg.norm(away)
        before = 3 + 9 * leaf // 12
        base = end[before]
        for piece in range(3):
            start.append(base + piece * away)
            end.append(base + (piece + 1) * away)
            diameter.append((0.0018, 0.0018))
            parent.append(before)
            branch.append(leaf + 1)
            before = len(start) - 1
    return tree_from_segments(start, end, diameter, parent=parent, branch=branch)
