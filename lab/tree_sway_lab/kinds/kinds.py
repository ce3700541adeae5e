# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The kinds: each a drawing of its own habit from the seed of its random numbers.

Their wood has 8 GPa and 900 kg/m^3, and they bear their own weight. A kind is called by its name,
``willow``, or with another seed, ``willow 7``; ``crooked 8`` and ``straight 1`` are the trees that
models are made with.

"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from tree_sway.core.tree import Tree
from tree_sway.errors import nearest, ParameterError
from tree_sway_lab.example_trees import forked_tree, RATIOS
from tree_sway_lab.kinds.shoots import Drawing, Shoot, towards
from tree_sway_lab.validation.crooked_trees import crooked_tree

SEED = 1
"""Seed of a kind that is called without one."""

_UP = np.array([0.0, 0.0, 1.0])
_GOLDEN = 137.50776


def kind_called(name: str) -> Tree:
    """
    Draw a tree.

    Parameters
    ----------
    name
        A kind of `KINDS`, and its seed if it is not `SEED`.

    Raises
    ------
    ParameterError
        If there is no such kind, or the seed is no number.

    """
    kind, _, seed = name.partition(' ')
    if kind not in KINDS or not (seed or '0').isdecimal():
        cure = nearest(kind, KINDS) or f'use one of: {", ".join(KINDS)}, with or without a seed'
        raise ParameterError(f"no kind of tree '{name}'", where='--kind', cure=cure)
    return KINDS[kind](int(seed or SEED))


def _willow(seed: int) -> Tree:
    """Draw 50 twigs of 3 to 5 m and 5 mm that hang from ten limbs."""
    to = Drawing(np.random.default_rng(seed))
    stem = to.shoot(_UP, 7.5, (0.26, 0.13), 7, wander=2.0)
    for k in range(10):
        limb = to.shoot(
            towards(k * _GOLDEN, to.rng.uniform(30.0, 55.0)), to.rng.uniform(1.8, 2.6),
            (0.055, 0.022), 5, on=stem, node=4 + k % 4, rise=-6.0, wander=4.0,
        )  # fmt: skip
        for j in range(5):
            to.shoot(
                towards(to.rng.uniform(0.0, 360.0), -40.0), to.rng.uniform(3.0, 5.0),
                (0.005, 0.003), 9, on=limb, node=1 + j, rise=-20.0, wander=2.0,
            )  # fmt: skip
    return to.tree(f'willow {seed}')


def _birch(seed: int) -> Tree:
    """Draw 22 fine limbs on one stem, each with two hanging twigs of 1.2 to 2.2 m and 3.5 mm."""
    to = Drawing(np.random.default_rng(seed))
    stem = to.shoot(_UP, 9.0, (0.14, 0.02), 11, wander=1.5)
    for k in range(22):
        node = 3 + k * 8 // 22
        limb = to.shoot(
            towards(k * _GOLDEN, to.rng.uniform(35.0, 60.0)), 2.4 - 0.16 * node,
            (0.024, 0.008), 5, on=stem, node=node, rise=-9.0, wander=4.0,
        )  # fmt: skip
        for node in (3, 5):
            to.shoot(
                towards(to.rng.uniform(0.0, 360.0), -20.0), to.rng.uniform(1.2, 2.2),
                (0.0035, 0.002), 6, on=limb, node=node, rise=-25.0, wander=3.0,
            )  # fmt: skip
    return to.tree(f'birch {seed}')


def _bamboo(seed: int) -> Tree:
    """Draw six culms of 3.5 to 5.5 m from one foot, a 200th as thick, with twigs of 4 mm."""
    to = Drawing(np.random.default_rng(seed))
    foot = to.shoot(_UP, 0.2, (0.3, 0.28), 1)
    for k in range(6):
        length = to.rng.uniform(3.5, 5.5)
        culm = to.shoot(
            towards(60.0 * k + to.rng.uniform(-15.0, 15.0), to.rng.uniform(74.0, 86.0)), length,
            (length / 200.0, length / 600.0), 12, on=foot, wander=1.5,
        )  # fmt: skip
        for node in (5, 7, 9, 11):
            to.shoot(
                towards(to.rng.uniform(0.0, 360.0), 35.0), to.rng.uniform(0.4, 0.7),
                (0.004, 0.0018), 4, on=culm, node=node, wander=4.0,
            )  # fmt: skip
    return to.tree(f'bamboo {seed}')


def _shoots(seed: int) -> Tree:
    """Draw a stump with sixteen shoots of one year, 1.2 to 2 m long and 4 to 7 mm thick."""
    to = Drawing(np.random.default_rng(seed))
    stem = to.shoot(_UP, 1.6, (0.16, 0.14), 3)
    for k in range(16):
        length = to.rng.uniform(1.2, 2.0)
        to.shoot(
            towards(k * _GOLDEN, to.rng.uniform(40.0, 80.0)), length,
            (0.0035 * length, 0.0014 * length), 8, on=stem, rise=2.0, wander=2.0,
        )  # fmt: skip
    return to.tree(f'shoots {seed}')


def _reeds(seed: int) -> Tree:
    """Draw ten stalks of 1.5 to 2.5 m from one foot, a 260th as thick, that carry nothing."""
    to = Drawing(np.random.default_rng(seed))
    foot = to.shoot(_UP, 0.1, (0.2, 0.2), 1)
    for k in range(10):
        length = to.rng.uniform(1.5, 2.5)
        to.shoot(
            towards(k * _GOLDEN, to.rng.uniform(70.0, 87.0)), length,
            (length / 260.0, length / 500.0), 10, on=foot, wander=2.0,
        )  # fmt: skip
    return to.tree(f'reeds {seed}')


def _limbs(count: int, seed: int) -> Tree:
    """Draw a stem with limbs that carry nothing, no two alike."""
    to = Drawing(np.random.default_rng(seed))
    stem = to.shoot(_UP, 8.0, (0.16, 0.04), 16)
    for k in range(count):
        length = to.rng.uniform(1.8, 3.0)
        to.shoot(
            towards(k * _GOLDEN, to.rng.uniform(15.0, 50.0)), length,
            (length / 45.0, length / 110.0), 6, on=stem, node=5 + k * 11 // count, wander=2.0,
        )  # fmt: skip
    return to.tree(f'limbs{count} {seed}')


def _spire(seed: int) -> Tree:
    """Draw a conifer of 50 branches in whorls of five, each with two side shoots in the lower."""
    to = Drawing(np.random.default_rng(seed))
    stem = to.shoot(_UP, 12.0, (0.18, 0.02), 14, wander=0.5)
    for whorl in range(10):
        for k in range(5):
            length = (2.4 - 0.2 * whorl) * to.rng.uniform(0.85, 1.15)
            branch = to.shoot(
                towards(72.0 * k + 31.0 * whorl, -8.0 + 5.0 * whorl), length,
                (length / 75.0, length / 300.0), 5, on=stem, node=3 + whorl, rise=2.0, wander=2.0,
            )  # fmt: skip
            if whorl < 3:
                for side in (-50.0, 50.0):
                    to.shoot(
                        towards(72.0 * k + 31.0 * whorl + side, -5.0), 0.4 * length,
                        (0.009, 0.004), 3, on=branch, node=3, wander=2.0,
                    )  # fmt: skip
    return to.tree(f'spire {seed}')


def _palm(seed: int) -> Tree:
    """Draw a bare stem with twenty arching fronds at its top."""
    to = Drawing(np.random.default_rng(seed))
    stem = to.shoot(_UP, 8.0, (0.15, 0.11), 10, wander=1.0)
    for k in range(20):
        to.shoot(
            towards(k * _GOLDEN, to.rng.uniform(5.0, 75.0)), to.rng.uniform(2.2, 2.9),
            (0.030, 0.006), 7, on=stem, rise=-11.0, wander=1.0,
        )  # fmt: skip
    return to.tree(f'palm {seed}')


def _leaning(seed: int) -> Tree:
    """Draw a stem that leans by 40 degrees, its limbs on the upper side."""
    to = Drawing(np.random.default_rng(seed))
    stem = to.shoot(towards(20.0, 50.0), 7.5, (0.20, 0.05), 10, rise=2.0, wander=2.0)
    for k in range(14):
        limb = to.shoot(
            towards(20.0 + (-1) ** k * to.rng.uniform(20.0, 110.0), to.rng.uniform(20.0, 65.0)),
            to.rng.uniform(1.2, 2.4), (0.045, 0.016), 5, on=stem, node=3 + k // 2, rise=3.0,
            wander=6.0,
        )  # fmt: skip
        for node in (3, 5):
            _twig(to, limb, node, 0.8)
    return to.tree(f'leaning {seed}')


def _shrub(seed: int) -> Tree:
    """Draw eight stems from one foot, each with its twigs."""
    to = Drawing(np.random.default_rng(seed))
    foot = to.shoot(_UP, 0.15, (0.16, 0.15), 1)
    for k in range(8):
        length = to.rng.uniform(2.2, 3.6)
        stem = to.shoot(
            towards(45.0 * k + to.rng.uniform(-12.0, 12.0), to.rng.uniform(50.0, 80.0)), length,
            (length / 70.0, length / 250.0), 8, on=foot, wander=4.0,
        )  # fmt: skip
        for node in (3, 4, 5, 6, 7):
            _twig(to, stem, node, 0.7)
    return to.tree(f'shrub {seed}')


def _candelabra(seed: int) -> Tree:
    """Draw five limbs that leave a short stem level, rise, and carry heavy tops."""
    to = Drawing(np.random.default_rng(seed))
    stem = to.shoot(_UP, 2.0, (0.26, 0.24), 4)
    for k in range(5):
        limb = to.shoot(
            towards(72.0 * k + to.rng.uniform(-15.0, 15.0), 5.0), to.rng.uniform(4.5, 5.5),
            (0.11, 0.05), 10, on=stem, rise=17.0, wander=2.0,
        )  # fmt: skip
        for j in range(7):
            _twig(to, limb, 7 + j % 4, 1.3, thick=0.020)
    return to.tree(f'candelabra {seed}')


def _broad(seed: int, whips: int = 0) -> Tree:
    """Draw a crown that forks unevenly, by rules of its own; whips of 4 mm at its ends if any."""
    to = Drawing(np.random.default_rng(seed))
    stem = to.shoot(_UP, 2.6, (0.21, 0.17), 4, wander=3.0)
    ends: list[Shoot] = []
    waiting = [(stem, 0, 2.6, 0.15)]
    while waiting:
        carrier, order, length, width = waiting.pop(0)
        if order == 3:
            ends.append(carrier)
            continue
        tip = len(carrier.nodes) - 1
        for k in range(3 if order < 2 else 2):
            here = carrier.direction_at(tip) + to.rng.uniform(0.45, 0.8) * _aside(
                to.rng, carrier.direction_at(tip)
            )
            here /= np.linalg.norm(here)
            long = length * to.rng.uniform(0.55, 0.85)
            wide = width * to.rng.uniform(0.5, 0.7)
            child = to.shoot(
                here, long, (wide, 0.55 * wide), 5 - order, on=carrier,
                node=tip if k == 0 else max(1, tip - k), rise=3.0, wander=8.0,
            )  # fmt: skip
            waiting.append((child, order + 1, long, wide))
    for end in ends[: 2 * whips : 2]:
        to.shoot(
            towards(to.rng.uniform(0.0, 360.0), 35.0), to.rng.uniform(1.2, 1.8), (0.004, 0.002),
            6, on=end, wander=4.0,
        )  # fmt: skip
    return to.tree(f'{"whips" if whips else "broad"} {seed}')


def _twig(to: Drawing, on: Shoot, node: int, length: float, thick: float = 0.010) -> None:
    """Add a twig somewhere off a shoot's direction."""
    along = on.direction_at(min(node, len(on.nodes) - 1))
    way = along + to.rng.uniform(0.6, 1.2) * _aside(to.rng, along)
    to.shoot(
        way / np.linalg.norm(way), length * to.rng.uniform(0.7, 1.3), (thick, 0.4 * thick), 3,
        on=on, node=node, rise=3.0, wander=5.0,
    )  # fmt: skip


def _aside(rng: np.random.Generator, along: np.ndarray) -> np.ndarray:
    """Random unit vector at a right angle to another."""
    way = rng.standard_normal(3)
    way -= (way @ along) * along
    return np.asarray(way / np.linalg.norm(way))


KINDS: dict[str, Callable[[int], Tree]] = {
    'willow': _willow,
    'birch': _birch,
    'bamboo': _bamboo,
    'shoots': _shoots,
    'reeds': _reeds,
    'limbs2': partial(_limbs, 2),
    'limbs4': partial(_limbs, 4),
    'limbs8': partial(_limbs, 8),
    'limbs16': partial(_limbs, 16),
    'limbs32': partial(_limbs, 32),
    'spire': _spire,
    'palm': _palm,
    'leaning': _leaning,
    'shrub': _shrub,
    'candelabra': _candelabra,
    'broad': _broad,
    'whips': partial(_broad, whips=14),
    'crooked': crooked_tree,
    'straight': lambda seed: forked_tree(*RATIOS[seed % len(RATIOS)]),
}
"""How each kind is drawn from a seed."""

HANGING = ('willow', 'birch')
"""Kinds whose twigs hang, stiff by their weight."""

FLEXIBLE = (*HANGING, 'whips')
"""Kinds of twigs that turn by a right angle in fresh wind."""

SLENDER = ('bamboo', 'shoots', 'reeds')
"""Kinds that bend to the ground in a storm."""
