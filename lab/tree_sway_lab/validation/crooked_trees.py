# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Random crooked trees to judge models on: three habits, 40 to 120 branches, nothing symmetrical.

Every branch wanders from segment to segment and bends up or down, no two lengths or diameters are
alike, children sit where they please. A tree of one stem, of forked limbs, or of low arching limbs
is drawn in turn; straight and symmetrical trees flatter every model.

"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.tree import Tree, tree_from_segments


class _Habit(NamedTuple):
    """
    Ranges that a habit draws from.

    Parameters
    ----------
    slender
        Length of the stem over its diameter.
    children
        How many branches each branch of an order bears, (least, most), one pair per order.
    length
        Length of a child over its parent's.
    slim
        Length of a child over its diameter, as scanned branches have it (24 to 45); it is never as
        thick as its parent.
    angle
        Angle from the parent's direction in [deg].
    low
        Lowest place of a child along its parent, from 0 to 1.
    rise
        Turn towards the sky per segment in [deg]; negative arches down.
    wander
        Random turn per segment in [deg], root mean square.

    """

    slender: tuple[float, float]
    children: tuple[tuple[int, int], ...]
    length: tuple[float, float]
    slim: tuple[float, float]
    angle: tuple[float, float]
    low: float
    rise: float
    wander: float


HABITS: dict[str, _Habit] = {
    'one stem': _Habit(
        (45, 60), ((12, 18), (1, 4), (0, 1)), (0.25, 0.5), (30, 50), (45, 85), 0.2, 3.0, 9.0
    ),
    'forked': _Habit(
        (24, 34), ((3, 5), (3, 5), (1, 4)), (0.4, 0.65), (28, 45), (25, 60), 0.4, 4.0, 12.0
    ),
    'arching': _Habit(
        (28, 38), ((5, 8), (3, 5), (1, 2)), (0.35, 0.6), (28, 48), (35, 80), 0.25, -6.0, 10.0
    ),
}
"""The three habits; seed k draws from the one at k modulo 3."""

_FEWEST, _MOST = 40, 120


def crooked_tree(seed: int) -> Tree:
    """
    Draw a tree.

    Parameters
    ----------
    seed
        Seed of the random numbers; also chooses the habit.

    Returns
    -------
    Tree
        A tree of 40 to 120 branches, 4 to 9 m high, for wood of 8 GPa and 900 kg/m^3.

    """
    name = tuple(HABITS)[seed % len(HABITS)]
    rng = np.random.default_rng(seed)
    while True:
        tree = _drawn(HABITS[name], rng, f'{name} {seed}')
        if _FEWEST <= tree.n_branches <= _MOST:
            return tree


class _Shoot(NamedTuple):
    """A branch to grow: where and which way, how long and thick, its order, segment it sits on."""

    base: Floats
    direction: Floats
    length: float
    diameter: float
    order: int
    carrying: int


def _drawn(habit: _Habit, rng: np.random.Generator, name: str) -> Tree:
    height = rng.uniform(4.0, 8.0)
    stem = _Shoot(
        np.zeros(3), np.array([0.0, 0.0, 1.0]), height, height / rng.uniform(*habit.slender), 0, -1
    )
    shoots: list[_Shoot] = [stem]
    rows: list[list[float]] = []
    branch: list[int] = []
    parents: list[int] = []
    for number, shoot in enumerate(shoots):
        nodes, widths = _axis(habit, rng, shoot)
        first = len(rows)
        rows += np.hstack([nodes[:-1], nodes[1:], widths[:-1, None], widths[1:, None]]).tolist()
        branch += [number] * (len(nodes) - 1)
        parents += [shoot.carrying, *range(first, len(rows) - 1)]
        if shoot.order < len(habit.children):
            least, most = habit.children[shoot.order]
            for _ in range(rng.integers(least, most + 1)):
                shoots.append(_child(habit, rng, shoot, nodes, widths, first))
    table = np.array(rows)
    return tree_from_segments(
        table[:, :3], table[:, 3:6], table[:, 6:], parent=np.array(parents),
        branch=np.array(branch), name=name,
    )  # fmt: skip


def _axis(habit: _Habit, rng: np.random.Generator, shoot: _Shoot) -> tuple[Floats, Floats]:
    """Nodes (m + 1, 3) and diameters (m + 1,) of a branch."""
    m = int(rng.integers(3, 7)) if shoot.order < 2 else int(rng.integers(2, 5))
    m += 3 * (shoot.order == 0)
    steps = rng.uniform(0.6, 1.4, m)
    steps *= shoot.length / steps.sum()
    share = 0.35 if shoot.order == 0 else 1.0
    nodes, direction = [shoot.base], shoot.direction
    for step in steps:
        nodes.append(nodes[-1] + step * direction)
        turn = math.radians(share * habit.wander) * rng.standard_normal(3)
        turn[2] += math.radians(habit.rise) * (shoot.order > 0)
        direction = direction + turn
        direction /= np.linalg.norm(direction)
    along = np.concatenate([[0.0], np.cumsum(steps)]) / shoot.length
    taper = rng.uniform(0.45, 0.75)
    widths = shoot.diameter * (1.0 - taper * along ** rng.uniform(0.8, 1.3))
    return np.array(nodes), widths


def _child(
    habit: _Habit,
    rng: np.random.Generator,
    parent: _Shoot,
    nodes: Floats,
    widths: Floats,
    first: int,
) -> _Shoot:
    """Draw a branch on a node of its parent."""
    m = len(nodes) - 1
    node = int(rng.integers(max(1, math.ceil(habit.low * m)), m + 1))
    direction = nodes[node] - nodes[node - 1]
    direction /= np.linalg.norm(direction)
    aside = rng.standard_normal(3)
    aside -= (aside @ direction) * direction
    aside /= np.linalg.norm(aside)
    angle = math.radians(rng.uniform(*habit.angle))
    way = math.cos(angle) * direction + math.sin(angle) * aside
    length = parent.length * rng.uniform(*habit.length)
    if parent.order == 0 and len(habit.children[0]) and habit.low < 0.25:
        length *= 1.2 - 0.8 * node / m
    slim = rng.uniform(*habit.slim)
    diameter = min(length / slim, 0.85 * widths[node])
    length = min(length, 1.2 * slim * diameter)
    return _Shoot(nodes[node], way, length, diameter, parent.order + 1, first + node - 1)
