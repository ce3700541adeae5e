# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The state of a steady-state filter, moved and corrected in arrays made once."""

from __future__ import annotations

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.observe.steady_filter import SteadyFilter

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

    """

    def __init__(self, gains: SteadyFilter, old: Estimate | None = None) -> None:
        self.gains = gains
        _, *shape = gains.law.step.shape
        self.state: Floats = np.zeros(shape)
        """Displacement, rate and disturbance of each coordinate, (3, m)."""
        if old is not None:
            self.state[:] = old.state
        n_measurements, lag = len(gains.sensed), gains.backward.shape[1]
        self.innovation = np.zeros(n_measurements)
        """What the last measurements had beyond those expected, (p,)."""
        self.innovations = np.zeros((max(lag, 1), n_measurements))
        """Those of the last steps, limited, the oldest first, (l, p)."""
        self._backward = gains.backward.reshape(len(gains.backward), -1)
        self._terms = np.zeros(gains.law.step.shape)
        self._flat = self.state.reshape(-1)
        self._change, self._past = np.zeros(len(self._flat)), np.zeros(shape[1])
        self._limit = _CLIPPED * gains.deviation
        self._gain = np.ascontiguousarray(gains.gain)
        self._scaled = np.zeros(n_measurements)
        self._squares = self._scaled.reshape(-1, 3)
        self._sizes = np.zeros(len(self._squares))

    def move(self, n_periods: int) -> None:
        """Move the state by a number of steps."""
        for _ in range(n_periods):
            np.multiply(self.gains.law.step, self.state, out=self._terms)
            np.add.reduce(self._terms, axis=1, out=self.state)

    def correct(self, beyond: Floats, unknown: list[slice]) -> None:
        """Correct the state by measurements (p,), some rows of which are not known."""
        innovation, used = self.innovation, self.innovations[-1]
        np.dot(self.gains.sensed, self._flat, out=innovation)
        np.subtract(beyond, innovation, out=innovation)
        for rows in unknown:
            innovation[rows] = 0.0
        if len(self.innovations) > 1:
            self.innovations[:-1] = self.innovations[1:]
        np.minimum(innovation, self._limit, out=used)
        np.maximum(used, -self._limit, out=used)
        np.dot(self._gain, used, out=self._change)
        self._flat += self._change

    def sizes(self) -> list[float]:
        """Mean square of the last innovations over that expected, of each three, (p / 3,)."""
        np.divide(self.innovation, self.gains.deviation, out=self._scaled)
        np.multiply(self._scaled, self._scaled, out=self._scaled)
        np.add.reduce(self._squares, axis=1, out=self._sizes)
        return [each / 3.0 for each in self._sizes.tolist()]

    def past_change(self) -> Floats:
        """
        Find what the innovations since tell about the displacements of the lag ago, (m,).

        The array is reused.
        """
        return np.dot(self._backward, self.innovations.reshape(-1), out=self._past)
