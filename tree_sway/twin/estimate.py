# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
State estimate of a steady-state filter: prediction and correction, in preallocated arrays.

What a sensor tells arrives with its noise, at every step anew. The motion that is shown moves by
the same law, and comes nearer to the estimate by a share of their difference at each
step: noise is averaged, while free sway, which both follow alike, is not late.
"""

from __future__ import annotations

import numpy as np

from tree_sway.core.arrays import Floats, Ints
from tree_sway.core.native import address, LIBRARY, NativeFilter, NativeReadings
from tree_sway.twin.steady_filter import SteadyFilter


class Estimate:
    """
    A filter and its state.

    Parameters
    ----------
    gains
        Law and gains.
    rows
        Row of each measurement among the readings of all sensors, 9 of each, (p,).
    old
        Estimate from which it continues; from zero if None.

    """

    def __init__(self, gains: SteadyFilter, rows: Ints, old: Estimate | None = None) -> None:
        self.gains = gains
        m = gains.law.step.shape[2]
        self.state, self.calm = np.zeros((2, 3, m))
        """Displacement, rate and disturbance of each coordinate, as told and calm, (3, m)."""
        self.calm_at = address(self.calm)
        if old is not None:
            self.state[:], self.calm[:] = old.state, old.calm
        self._native = NativeFilter(
            coordinates=m, measurements=len(rows),
            law=np.ascontiguousarray(gains.law.step), sensed=gains.sensed.T.copy(),
            gain=gains.gain.T.copy(), deviation=gains.deviation, row=rows, state=self.state,
            calm=self.calm, innovations=np.zeros(len(rows)),
        )  # fmt: skip

    def advance(self, readings: NativeReadings, n_periods: int) -> None:
        """Move by a number of steps, correct by sensors that are known, and judge these."""
        LIBRARY.sway_correct(self._native.at, readings.at, n_periods)

    def tried(self, measured: Floats) -> Floats:
        """
        Correct it by measurements (n, p), a step after each other.

        Returns the mean squares of the innovations, (p,). No sensor is judged.
        """
        squares = np.zeros(measured.shape[1])
        rows = np.ascontiguousarray(measured)
        LIBRARY.sway_try(self._native.at, address(rows), len(rows), address(squares))
        return squares / len(rows)

    def move(self, n_periods: int) -> None:
        """Move by a number of steps."""
        for _ in range(n_periods):
            for each in (self.state, self.calm):
                each[:] = (self.gains.law.step * each).sum(axis=1)

    def scale(self, share: float) -> None:
        """Scale the motion by a share."""
        self.state *= share
        self.calm *= share
