# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The motion of a fixed lag ago, by what has been measured since.

The displacements that were estimated then are corrected by the innovations since (`steady_filter`)
and averaged over a short window.
"""

from __future__ import annotations

import numpy as np

from tree_sway.core.arrays import Floats

SMOOTHED_LAG = 6
"""Steps between the smoother's estimate and its newest measurement."""

_WINDOW = np.hanning(9)[1:-1] / np.hanning(9)[1:-1].sum()
_WINDOWS = np.stack([np.roll(_WINDOW, k) for k in range(len(_WINDOW))])
"""Shares of the rows of a window whose oldest row is each of them."""

LATE_STEPS = SMOOTHED_LAG + len(_WINDOW) // 2
"""Steps by which the smoothed state is late."""

_KEPT = 64
"""Steps that are kept: more than the largest lateness of a sensor and the lag."""


class SmoothedMotion:
    """
    The smoothed displacements of the coordinates of a model.

    Parameters
    ----------
    n_coordinates
        Number of coordinates of the model.
    count
        Number of the first ones that are corrected.

    """

    def __init__(self, n_coordinates: int, count: int) -> None:
        self._computed = np.zeros((_KEPT, n_coordinates))
        self._estimated = np.zeros((_KEPT, count))
        self._window = np.zeros((len(_WINDOW), n_coordinates))
        self._oldest = 0
        self._out = np.zeros(n_coordinates)
        self._added = np.zeros(count)

    def note_computed(self, step: int, eta: Floats) -> None:
        """Note the displacements that the model has in the wind alone at a step, (m,)."""
        self._computed[step % _KEPT] = eta

    def add_computed(self, step: int, eta: Floats) -> None:
        """Add to the displacements of a step, (m,)."""
        self._computed[step % _KEPT] += eta

    def note_estimated(self, first: int, last: int, eta: Floats | float) -> None:
        """Note the estimated differences, (count,) or 0, of the steps from first to last."""
        for step in range(first, last + 1):
            self._estimated[step % _KEPT] = eta

    def smooth(self, step: int, trust: Floats, change: Floats | None) -> None:
        """
        Estimate the displacements of the lag before a step, and keep them for the window.

        Parameters
        ----------
        step
            Step of the newest measurement.
        trust
            Share of the difference that is applied, (count,).
        change
            What the innovations tell about the difference of the lag ago, (count,); None without
            a measurement.

        """
        then = (step - SMOOTHED_LAG) % _KEPT
        added = self._added
        np.add(self._estimated[then], 0.0 if change is None else change, out=added)
        added *= trust
        row = self._window[self._oldest]
        row[:] = self._computed[then]
        row[: len(added)] += added
        self._oldest = (self._oldest + 1) % len(_WINDOW)

    @property
    def displacements(self) -> Floats:
        """Displacements of `LATE_STEPS` ago, (m,). The array is reused."""
        return np.dot(_WINDOWS[self._oldest], self._window, out=self._out)

    def reset(self) -> None:
        """Forget the motion."""
        self._computed[:] = 0.0
        self._estimated[:] = 0.0
