# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
State estimate of a steady-state filter: prediction and correction, in preallocated arrays.

What a sensor tells arrives with its noise, at every step anew. The motion that is shown moves by
the same law, and comes nearer to the estimate by a share of their difference at each step
(`PACE`): noise is averaged, while free sway, which both follow alike, is not late.
"""

from __future__ import annotations

from functools import partial

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.arrays import Floats
from tree_sway.core.kernel import entry_of, kernel, WHY_PLAIN
from tree_sway.core.observe.steady_filter import SteadyFilter

PACE = 0.15
"""Share of the difference from the estimate by which the calm motion comes nearer per step."""

_CLIPPED = 6.0
"""Largest innovation that corrects, in its standard deviations."""


class Estimate:
    """
    A filter, its state, and the innovations of the last steps.

    Parameters
    ----------
    gains
        Law and gains.
    old
        Estimate from which it continues; from zero if None.
    plain
        Whether numpy is used where a compiler is there.

    """

    def __init__(
        self, gains: SteadyFilter, old: Estimate | None = None, *, plain: bool = bool(WHY_PLAIN)
    ) -> None:
        self.gains = gains
        _, *shape = gains.law.step.shape
        self.state, self.calm = np.zeros((2, *shape))
        """Displacement, rate and disturbance of each coordinate, as told and calm, (3, m)."""
        if old is not None:
            self.state[:], self.calm[:] = old.state, old.calm
        n_measurements, lag = len(gains.sensed), gains.backward.shape[1]
        self.innovation = np.zeros(n_measurements)
        """What the last measurements had beyond those expected, (p,)."""
        self.innovations = np.zeros((max(lag, 1), n_measurements))
        """Those of the last steps, limited, the oldest first, (l, p)."""
        self._backward = gains.backward.reshape(len(gains.backward), -1)
        self._past = np.zeros(shape[1])
        self.sizes = np.zeros(n_measurements // 3)
        """Mean square of the last innovations over that expected, of each three, (p / 3,)."""
        law, deviation = np.ascontiguousarray(gains.law.step), gains.deviation
        sensed, gain = (np.ascontiguousarray(each) for each in (gains.sensed, gains.gain))
        states = self.state, self.calm, self.innovation, self.innovations, self.sizes
        given = np.zeros(n_measurements), np.zeros(n_measurements, dtype=np.bool_)
        steps = law, sensed, gain, deviation, *states
        self._advance = partial(advance_in_numpy, *steps)
        if not plain:
            self._advance = partial(entry_of(advance, *steps, *given, 1), *steps)

    def advance(self, beyond: Floats, is_known: NDArray[np.bool_], n_periods: int) -> None:
        """Move by a number of steps, and correct by measurements (p,) where they are known."""
        self._advance(beyond, is_known, n_periods)

    def move(self, n_periods: int) -> None:
        """Move by a number of steps."""
        for _ in range(n_periods):
            for each in (self.state, self.calm):
                each[:] = (self.gains.law.step * each).sum(axis=1)

    def scale(self, share: float) -> None:
        """Scale the motion by a share."""
        self.state *= share
        self.calm *= share

    def past_change(self) -> Floats:
        """
        Find what the innovations since tell about the displacements of the lag ago, (m,).

        The array is reused.
        """
        return np.dot(self._backward, self.innovations.reshape(-1), out=self._past)


@kernel
def advance(
    step: Floats, sensed: Floats, gain: Floats, deviation: Floats, state: Floats, calm: Floats,
    innovation: Floats, innovations: Floats, sizes: Floats, beyond: Floats,
    is_known: NDArray[np.bool_], n_periods: int,
) -> None:  # fmt: skip
    """
    Move an estimate by its law, and correct it.

    Parameters
    ----------
    step
        State after a step by that before, of each coordinate, (3, 3, m).
    sensed, gain
        Measurements by the state, (p, 3 m), and its correction by their innovations, (3 m, p).
    deviation
        Standard deviation of each innovation, (p,).
    state, calm
        The state as it is told, and calm, (3, m), written.
    innovation, innovations
        Innovation (p,), and those of the last steps, limited, (l, p), written.
    sizes
        Mean square of each three innovations over that expected, (p / 3,), written.
    beyond, is_known
        Measurements, and which of them are there, (p,).
    n_periods
        Steps since the last correction.

    """
    m, p = step.shape[2], len(beyond)
    for _ in range(n_periods):
        for each in (state, calm):
            for i in range(m):
                eta, rate, force = each[0, i], each[1, i], each[2, i]
                for j in range(3):
                    moved = step[j, 0, i] * eta + step[j, 1, i] * rate
                    each[j, i] = moved + step[j, 2, i] * force
    for k in range(1, len(innovations)):
        for r in range(p):
            innovations[k - 1, r] = innovations[k, r]
    used = innovations[-1]
    sizes[:] = 0.0
    for r in range(p):
        expected = 0.0
        for j in range(3):
            for i in range(m):
                expected += sensed[r, j * m + i] * state[j, i]
        innovation[r] = beyond[r] - expected if is_known[r] else 0.0
        limit = _CLIPPED * deviation[r]
        used[r] = min(max(innovation[r], -limit), limit)
        sizes[r // 3] += (innovation[r] / deviation[r]) ** 2 / 3.0
    for j in range(3):
        for i in range(m):
            for r in range(p):
                state[j, i] += gain[j * m + i, r] * used[r]
            calm[j, i] += PACE * (state[j, i] - calm[j, i])


@kernel
def carry(
    ahead: Floats, calm: Floats, wanted: Floats, share: float, trust: Floats, moved: Floats
) -> None:
    """
    Bring a calm motion to the present, as far as each coordinate of it is trusted.

    Parameters
    ----------
    ahead
        State of the present by that of the measurements, of each coordinate, (3, 3, m).
    calm
        The calm state, (3, m).
    wanted, share
        Trust of new gains, (m,), and the share of the way towards it.
    trust
        Share of the correction to apply, (m,), written.
    moved
        Displacement and rate of the correction, (2, m), written.

    """
    for i in range(len(trust)):
        trust[i] += share * (wanted[i] - trust[i])
        eta, rate, force = calm[0, i], calm[1, i], calm[2, i]
        for j in range(2):
            present = ahead[j, 0, i] * eta + ahead[j, 1, i] * rate + ahead[j, 2, i] * force
            moved[j, i] = trust[i] * present


def carry_in_numpy(
    ahead: Floats, calm: Floats, wanted: Floats, share: float, trust: Floats, moved: Floats
) -> None:
    """Bring a calm motion to the present as `carry`."""
    trust += share * (wanted - trust)
    moved[:] = trust * (ahead[:2] * calm).sum(axis=1)


def advance_in_numpy(
    step: Floats, sensed: Floats, gain: Floats, deviation: Floats, state: Floats, calm: Floats,
    innovation: Floats, innovations: Floats, sizes: Floats, beyond: Floats,
    is_known: NDArray[np.bool_], n_periods: int,
) -> None:  # fmt: skip
    """Move and correct an estimate as `advance`."""
    for _ in range(n_periods):
        for each in (state, calm):
            each[:] = (step * each).sum(axis=1)
    innovation[:] = np.where(is_known, beyond - sensed @ state.reshape(-1), 0.0)
    innovations[:-1] = innovations[1:]
    limit = _CLIPPED * deviation
    np.clip(innovation, -limit, limit, out=innovations[-1])
    sizes[:] = np.square(innovation / deviation).reshape(-1, 3).mean(axis=1)
    state += (gain @ innovations[-1]).reshape(state.shape)
    calm += PACE * (state - calm)
