# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Estimates of error and cost of every number of coordinates, made before a step.

The tree is linear to first order, so the error of fewer coordinates follows without a trial: it is
the response of the coordinates left out, summed over the frequencies of the wind's load and joined
from the root to the tips of all branches. The nonlinear error is added: it grows with the largest
rotation of any chain of branches in that wind, for winds from all sides, up and down included.

Symbols: H response of a coordinate, q its load, T the motion of tips by it, S the load's spectrum.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
import math
from typing import cast

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.drag import drag_density
from tree_sway.core.run import Bank, TableOscillators
from tree_sway.core.setup import branch_rotations, tip_motion, WindMoments
from tree_sway.fidelity.climate import WindClimate

DIAL = (0, 3, 6, 12, 20, 40, 60)
"""Numbers of coordinates to choose from, beside the number of all."""

_MARGIN = 1.4
"""Factor of estimated over computed error: the effect of the wind is not quite linear."""

_FLOOR = 0.06
"""Error of all coordinates against every segment solved, as a share of the motion."""

_TURN, _MOST_TURN = 0.4, 1.4
"""
Further share per squared largest rotation of a chain in [rad], and its saturation, per squared
rotation.

"""

_LIFT, _LIFT_FLOOR = 3.5, 0.05
"""
Further share per radian of that rotation, and at any rotation, in vertical wind: it blows along
hanging branches and buckles them, which no linear model has.

"""

_SOFT = 2.0
"""
Further share per radian of rotation by weight: a tree that nearly buckles leans by more than the
linear response.

"""

_MOST = 2.0
"""Largest sum of these shares."""

_FREQUENCIES = np.concatenate([[0.0], np.geomspace(0.01, 30.0, 80)])
"""Frequencies in [Hz], beside those near the coordinates."""

_APART = np.pi / 8.0
_N_BEARINGS = 4


def _axes_at(bearing: float) -> Floats:
    """Return axes along a bearing [rad], across it and up, as rows."""
    cosine = np.cos(bearing)
    sine = np.sin(bearing)
    along = [cosine, sine, 0.0]
    across = [-sine, cosine, 0.0]
    up = [0.0, 0.0, 1.0]
    return np.array([along, across, up])


_AXES = [_axes_at(bearing) for bearing in _APART * np.arange(_N_BEARINGS)]
"""
Directions of winds: the load of an oblique wind is not the sum of loads along and across a branch,
so it is linearised about the nearest of these directions.
"""

_BESIDE = np.array([0.96, 1.0, 1.04])
"""Multiples of the frequency of a coordinate at which its response is computed."""


@dataclass(frozen=True)
class Estimate:
    """
    Error of a number of coordinates in a wind, and its cost per step and placing [us].

    ``error`` bounds the root mean square over time and tips of the error, ``motion`` is that of
    the motion of the tips about its mean, both in [m]; ``turn`` is the largest rotation of a
    chain, [rad].
    """

    n_coordinates: int
    error: float
    motion: float
    cost: float
    turn: float = 0.0

    @property
    def name(self) -> str:
        """Return the value of the parameter ``model``."""
        return str(self.n_coordinates)


class ErrorEstimator:
    """
    Errors of every number of coordinates of one tree, in any wind.

    Parameters
    ----------
    bank
        Tree with the largest number of coordinates, the important ones first.

    """

    def __init__(self, bank: Bank) -> None:
        """Find the motion of the tips by each coordinate."""
        self._bank = bank
        model = bank.model
        self._law = model.drag_law
        branches = bank.branches
        shapes = bank.oscillators.shapes
        m = shapes.shape[1]
        fewer = [count for count in DIAL if count < m]
        self.dial = (*fewer, m)
        """Numbers of coordinates that are estimated."""
        # A branch may be cut: its tip is that of its last piece.
        is_last = np.isin(branches['end'], model.tree.branch_first[1:])
        moved = tip_motion(branches, shapes)
        tips = moved[is_last].reshape(-1, m)
        self._inner = tips.T @ tips / is_last.sum()
        self._turns = branch_rotations(branches, shapes)
        winds = np.concatenate(_AXES)
        loads = WindMoments(branches).at_rest(winds, shapes)
        self._loads = np.hsplit(loads.T, _N_BEARINGS)
        per_branch: Floats = 2.0 * (branches['area'] * branches['speed'])
        self._air_damping = per_branch @ model.participation
        """Damping of each coordinate by the air per drag and speed, at least, (m,)."""
        self._costs = [frame_cost(bank, k) for k in self.dial]
        self.refresh()

    def refresh(self) -> None:
        """Take over the present tuning of the tree."""
        tunable = self._bank.oscillators.tunable
        self._stiffness = tunable.stiffness.copy()
        self._own_damping = tunable.damping.copy()
        natural = np.sqrt(self._stiffness) / (2.0 * np.pi)
        near_natural = np.outer(natural, _BESIDE)
        self._frequencies = np.union1d(_FREQUENCIES, near_natural)
        self._grams = lru_cache(maxsize=8)(self._find_grams)

    def estimates(self, climate: WindClimate) -> list[Estimate]:
        """Estimate every number of coordinates in a wind, the fewest first."""
        per_square = drag_density(climate.speed, *self._law)
        steady, upward = _steady_wind(climate)
        azimuth = np.arctan2(steady[1], steady[0])
        bearing = int(np.rint(azimuth / _APART)) % _N_BEARINGS
        swings, squares = self._tip_squares(climate, bearing)
        root_mean_squares = np.sqrt([swings[0], squares[0]])
        swing, offset = per_square * root_mean_squares
        load = self._loads[bearing] @ _AXES[bearing] @ (per_square * steady)
        turn, soft = self._largest_turns(load)
        gusts = 1.0 + 2.0 * swing / max(offset, 1e-12)
        turn = float(gusts * turn)
        soft = float(gusts * soft)
        # A branch that rotates far yields to the wind, and moves no farther than its length.
        per_square /= math.sqrt(1.0 + turn**2 / 9.0)
        swing, offset = per_square * root_mean_squares
        beyond = _nonlinear_share(turn, soft, upward) * offset
        found = []
        for count, square, cost in zip(self.dial, squares, self._costs, strict=True):
            missed = 0.0
            if count < self.dial[-1]:
                missed = _MARGIN * per_square * math.sqrt(square)
            error = math.hypot(missed, beyond)
            found.append(Estimate(count, error, float(swing), cost, turn))
        return found

    def _tip_squares(self, climate: WindClimate, bearing: int) -> tuple[Floats, Floats]:
        """
        Find the mean square motion of the tips by the coordinates left out, by number, (k,).

        First the motion about the mean, then from rest; per squared `drag_law.drag_density`.
        """
        axes = _AXES[bearing]
        # Damped by the air at least as in a wind of the next lower of a few speeds.
        slow = 0.0
        if climate.speed >= 1.0:
            slow = 2.0 ** math.floor(math.log2(climate.speed))
        grams = self._grams(slow, bearing)
        power = axes @ climate.power(self._frequencies) @ axes.T
        about_mean = grams @ power.ravel()
        mean = axes @ climate.mean
        power[0] += np.outer(mean, mean)
        from_rest = grams @ power.ravel()
        return np.maximum(about_mean, 0.0), np.maximum(from_rest, 0.0)

    def _largest_turns(self, load: Floats) -> tuple[float, float]:
        """Find the largest turn from rest [rad] under steady modal loads, and that by weight."""
        amounts = load / self._stiffness
        softening = -self._bank.oscillators.tunable.weight
        by_weight = np.maximum(softening / self._stiffness, 0.0)
        both = np.stack([amounts, by_weight * amounts], axis=1)
        turns = self._turns @ both
        squares = np.square(turns).sum(axis=1)
        turn, soft = np.sqrt(squares.max(axis=0)).tolist()
        return turn, soft

    def _find_grams(self, speed: float, bearing: int) -> Floats:
        """Return inner products of tip motions of the last coordinates, by number, (k, 9 f)."""
        drag = drag_density(speed, *self._law)
        damping = self._own_damping + drag * speed * self._air_damping
        circular = 2.0 * np.pi * self._frequencies[:, None]
        impedance = self._stiffness - circular**2 + 1j * damping * circular
        responses = self._loads[bearing] / impedance[:, :, None]
        found = []
        for count in self.dial[:-1]:
            left_out = responses[:, count:]
            moved = self._inner[count:, count:] @ left_out
            products = np.einsum('fmi,fmj->fij', left_out.conj(), moved)
            found.append(products.real.ravel())
        found.append(np.zeros(len(circular) * 9))  # of all coordinates none is left out
        return np.stack(found)


def _nonlinear_share(turn: float, soft: float, upward: float) -> float:
    """
    Return the error of all coordinates as a share of the motion.

    The largest turns of a chain, in all and by weight, are in [rad]; ``upward`` is how far the
    wind is vertical.
    """
    by_turn = _TURN * turn**2 / (1.0 + _MOST_TURN * turn**2)
    by_lift = (_LIFT_FLOOR + _LIFT * turn) * upward
    return min(_FLOOR + by_turn + _SOFT * soft + by_lift, _MOST)


def _steady_wind(climate: WindClimate) -> tuple[Floats, float]:
    """
    Return a steady wind of the strength and axis of a climate, and how far the axis is vertical.

    It is along the largest principal axis of the second moments, with their root mean square: a
    wind that reverses has no mean direction.
    """
    second_moments = np.outer(climate.mean, climate.mean) + climate.covariance
    squares, axes = np.linalg.eigh(second_moments)
    strength = math.sqrt(max(squares[-1], 0.0))
    axis = axes[:, -1]
    return strength * axis, abs(float(axis[2]))


def dialled(bank: Bank) -> TableOscillators:
    """Return the oscillators of a number of coordinates, the last of which can be left out."""
    return cast(TableOscillators, bank.oscillators)


_CALL = 4.0
"""Fixed cost of a step, and of placing, in [us]."""

_PLACE_BRANCH, _PLACE_ENRICHED, _PLACE_SEGMENT = 0.03, 0.12, 0.013
"""Cost of placing a branch, a further shape and a segment in [us]."""

_STEP_SQUARE, _PLACE_SHAPE = 1.0e-3, 1.0e-4
"""Cost of stepping a pair of coordinates, and of placing a shape on a key rotation, in [us]."""

_STEP_BRANCH = 0.15
"""Cost of stepping a branch by its own load, without a table, in [us]."""


def frame_cost(bank: Bank, n_coordinates: int | None = None) -> float:
    """
    Return the cost in [us] of one step and one placing of a tree on a number of coordinates.

    Prices are fits to trees of 31 to 1,001 branches, timed on one core of a server of 2020.
    """
    branches = bank.branches
    oscillators = bank.oscillators
    n = len(branches)
    n_keys = branches['n_coordinates']
    n_segments = branches['end'] - branches['first']
    place = _CALL + _PLACE_BRANCH * n
    place += _PLACE_ENRICHED * int((n_keys > 2).sum())
    place += _PLACE_SEGMENT * int(n_segments.sum())
    if oscillators.loads is not None:
        return place + _CALL + _STEP_BRANCH * n
    m = n_coordinates
    if m is None:
        m = oscillators.shapes.shape[1]
    step = _CALL + _STEP_SQUARE * m * m
    return place + step + _PLACE_SHAPE * m * int(n_keys.sum())
