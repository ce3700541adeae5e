# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
How much model a scene needs: error and cost of every number of coordinates, known before a step.

The tree is linear to first order, so what fewer coordinates miss need not be tried: it is the
response of those left out, summed over the frequencies of the wind's load and joined from the root
to the tips of all branches. To it comes what no linear model knows: it grows with the largest turn
that any chain of branches makes in that wind, from whatever side it blows, up and down included.

Symbols: H response of a coordinate, q its load, T the motion of tips by it, S the load's spectrum.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
import math
from typing import cast, Protocol

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.motion.drag import DragLaw, pressure
from tree_sway.core.motion.response import branch_rotations, tip_motion
from tree_sway.core.motion.static_responses import WindMoments
from tree_sway.core.simulator.bank import Bank, Oscillators
from tree_sway.core.tree.tree import Tree
from tree_sway.core.wind.climate import WindClimate

DIAL = (0, 3, 6, 12, 20, 40, 60)
"""Numbers of coordinates among which is chosen, and all that there are."""

MARGIN = 1.4
"""Estimated over computed error: the wind is not quite linear in its effect."""

FLOOR = 0.06
"""Share of the motion by which even all coordinates may err against every segment solved."""

TURN, MOST_TURN = 0.4, 1.4
"""
Share of the motion on top of that, per square of the largest turn of a chain in [rad], and how
that share levels off, per square of it.

"""

LIFT, LIFT_FLOOR = 3.5, 0.05
"""
Share on top per radian of that turn, and at any turn, in wind straight up or down: it runs along
what hangs in it, and pushes it over, which no linear model knows.

"""

SOFT = 2.0
"""
Share on top per radian of turn that weight makes: what nearly buckles leans by more than the
linear answer.

"""

_MOST = 2.0
"""Most that all of these shares come to."""

_FREQUENCIES = np.concatenate([[0.0], np.geomspace(0.01, 30.0, 80)])
"""In [Hz], beside those around which coordinates swing."""

_APART = np.pi / 8.0
_AXES = [
    np.array([[np.cos(b), np.sin(b), 0.0], [-np.sin(b), np.cos(b), 0.0], [0.0, 0.0, 1.0]])
    for b in _APART * np.arange(4)
]
"""
Sides that winds come from: an oblique wind on a branch is no sum of winds along and across it, so
that the load is linear about the side that is nearest to that of the wind.
"""

_BESIDE = np.array([0.96, 1.0, 1.04])
"""Shares of the frequency of a coordinate at which its answer is found."""


@dataclass(frozen=True)
class Estimate:
    """
    What a number of coordinates is worth in a wind, and costs per step and placing [us].

    ``error`` bounds the root mean square over time and tips of the error, ``motion`` is that of
    the motion of the tips about its mean, both in [m]; ``turn`` is the largest of a chain, [rad].
    """

    n_coordinates: int
    error: float
    motion: float
    cost: float
    turn: float = 0.0

    @property
    def name(self) -> str:
        """Return what the parameter ``model`` would be for it."""
        return str(self.n_coordinates)


class Dialled(Oscillators, Protocol):
    """Oscillators of which some can be left out, those that matter most first."""

    @property
    def air_damping(self) -> Floats:
        """Damping of each coordinate by the air per drag and speed, at least, (m,)."""

    def show(self, shares: Floats, count: int) -> None:
        """Show coordinates by shares from 0 to 1, (m,), and let the first of them respond."""


class ErrorEstimator:
    """
    The error of every number of coordinates of one tree, in any wind.

    Parameters
    ----------
    tree, bank
        The tree, and the same on as many coordinates as it ever takes, the important ones first.
    drag_law
        Its law of drag.

    """

    def __init__(self, tree: Tree, bank: Bank, drag_law: DragLaw) -> None:
        """Find what each coordinate does to the tips."""
        self._bank, self._law = bank, drag_law
        branches, shapes = bank.branches, bank.oscillators.shapes
        m = shapes.shape[1]
        self.dial = tuple(sorted({k for k in DIAL if k < m} | {m}))
        """Numbers of coordinates that are judged."""
        # A branch may be cut: its tip is that of its last piece.
        ends = np.isin(branches['end'], tree.branch_first[1:])
        tips = tip_motion(branches, shapes)[ends].reshape(-1, m)
        self._inner = tips.T @ tips / ends.sum()
        self._turns = branch_rotations(branches, shapes)
        loads = WindMoments(branches).at_rest(np.concatenate(_AXES), shapes)
        self._loads = np.hsplit(loads.T, len(_AXES))
        self._air_damping = dialled(bank).air_damping
        self._costs = [frame_cost(bank, k) for k in self.dial]
        self.refresh()

    def refresh(self) -> None:
        """Take the tree as it is tuned now."""
        tunable = self._bank.oscillators.tunable
        self._stiffness, self._own_damping = tunable.stiffness.copy(), tunable.damping.copy()
        natural = np.sqrt(self._stiffness) / (2.0 * np.pi)
        self._frequencies = np.union1d(_FREQUENCIES, np.outer(natural, _BESIDE))
        self._grams = lru_cache(maxsize=8)(self._find_grams)

    def estimates(self, climate: WindClimate) -> list[Estimate]:
        """Judge every number of coordinates in a wind, the fewest first."""
        per_square = pressure(climate.speed, *self._law)
        mean = climate.mean
        # A wind that turns back has no mean: what it mostly does counts.
        squares, ways = np.linalg.eigh(np.outer(mean, mean) + climate.covariance)
        steady = math.sqrt(max(squares[-1], 0.0)) * ways[:, -1]
        bearing = int(np.rint(np.arctan2(steady[1], steady[0]) / _APART)) % len(_AXES)
        axes = _AXES[bearing]
        # The air damps at least as in a wind of the next lower of a few speeds.
        slow = 2.0 ** math.floor(math.log2(climate.speed)) if climate.speed >= 1.0 else 0.0
        grams = self._grams(slow, bearing)
        power = axes @ climate.power(self._frequencies) @ axes.T
        swings = np.maximum(grams @ power.ravel(), 0.0)
        power[0] += np.outer(axes @ mean, axes @ mean)
        squares = np.maximum(grams @ power.ravel(), 0.0)
        swing, offset = per_square * np.sqrt([swings[0], squares[0]])
        turn, soft = self._largest_turns(self._loads[bearing] @ axes @ (per_square * steady))
        gusts = 1.0 + 2.0 * swing / max(offset, 1e-12)
        turn, soft = gusts * turn, gusts * soft
        upward = abs(ways[2, -1])
        share = FLOOR + TURN * turn**2 / (1.0 + MOST_TURN * turn**2) + SOFT * soft
        share += (LIFT_FLOOR + LIFT * turn) * upward
        # What turns far gives way to the wind, and goes no farther than its length.
        per_square /= math.sqrt(1.0 + turn**2 / 9.0)
        swing, offset = per_square * np.sqrt([swings[0], squares[0]])
        beyond = min(share, _MOST) * offset
        found = []
        for k, square, cost in zip(self.dial, squares, self._costs, strict=True):
            missed = MARGIN * per_square * math.sqrt(square) if k < self.dial[-1] else 0.0
            found.append(Estimate(k, math.hypot(missed, beyond), float(swing), cost, float(turn)))
        return found

    def _largest_turns(self, load: Floats) -> tuple[float, float]:
        """Find the largest turn from rest [rad] under steady modal loads, and that by weight."""
        amounts = load / self._stiffness
        by_weight = np.maximum(-self._bank.oscillators.tunable.weight / self._stiffness, 0.0)
        turns = self._turns @ np.stack([amounts, by_weight * amounts], axis=1)
        turn, soft = np.sqrt(np.square(turns).sum(axis=1).max(axis=0)).tolist()
        return turn, soft

    def _find_grams(self, speed: float, bearing: int) -> Floats:
        """Inner products of what the last coordinates do to tips, by their number, (k, 9 f)."""
        damping = self._own_damping + pressure(speed, *self._law) * speed * self._air_damping
        circular = 2.0 * np.pi * self._frequencies[:, None]
        impedance = self._stiffness - circular**2 + 1j * damping * circular
        responses = self._loads[bearing] / impedance[:, :, None]
        found = []
        for k in self.dial:
            left = responses[:, k:] if k < self.dial[-1] else responses[:, :0]
            moved = self._inner[k:, k:] @ left if left.size else left
            found.append(np.einsum('fmi,fmj->fij', left.conj(), moved).real.ravel())
        return np.stack(found)


def dialled(bank: Bank) -> Dialled:
    """Return the oscillators of a number of coordinates."""
    return cast(Dialled, bank.oscillators)


_CALL = 4.0
"""Of a step, and of placing, however small the tree in [us]."""

_PLACE_BRANCH, _PLACE_ENRICHED, _PLACE_SEGMENT = 0.03, 0.12, 0.013
"""Of placing: a branch, what further shapes add, a segment."""

_STEP_SQUARE, _PLACE_SHAPE = 1.0e-3, 1.0e-4
"""Of stepping: a coordinate on a coordinate; of placing: a shape on a key rotation."""

_STEP_BRANCH = 0.15
"""Of stepping a branch by its own load, where there is no table."""


def frame_cost(bank: Bank, n_coordinates: int | None = None) -> float:
    """
    Cost in [us] of one step and one placing of a tree, of a number of its coordinates.

    Prices are fits to trees of 31 to 1,001 branches, timed on one core of a server of 2020.
    """
    branches, oscillators = bank.branches, bank.oscillators
    n = len(branches)
    enriched = int((branches['n_coordinates'] > 2).sum())
    segments = int((branches['end'] - branches['first']).sum())
    place = _CALL + _PLACE_BRANCH * n + _PLACE_ENRICHED * enriched + _PLACE_SEGMENT * segments
    if oscillators.loads is not None:
        return place + _CALL + _STEP_BRANCH * n
    m = oscillators.shapes.shape[1] if n_coordinates is None else n_coordinates
    step = _CALL + _STEP_SQUARE * m * m
    return place + step + _PLACE_SHAPE * m * int(branches['n_coordinates'].sum())
