# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The motion of a fixed lag ago, by what has been measured since.

The displacements that were estimated then are corrected by the innovations since (`steady_filter`)
and averaged over a short window.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.kernel import entry_of, kernel, WHY_PLAIN

SMOOTHED_LAG = 6
"""Steps between the smoother's estimate and its newest measurement."""

_WINDOW = np.hanning(9)[1:-1] / np.hanning(9)[1:-1].sum()

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
    plain
        Whether numpy is used where a compiler is there.

    """

    def __init__(self, n_coordinates: int, count: int, *, plain: bool = bool(WHY_PLAIN)) -> None:
        self._plain = plain
        self._computed = np.zeros((_KEPT, n_coordinates))
        self._estimated = np.zeros((_KEPT, count))
        self._window = np.zeros((len(_WINDOW), n_coordinates))
        self._out = np.zeros(n_coordinates)
        self._no_change = np.zeros(count)

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
        added = self._no_change if change is None else change
        self._push(self._computed, self._estimated, then, trust, added, self._window)

    @cached_property
    def _push(self) -> Callable[..., None]:
        if self._plain:
            return push_in_numpy
        n = self._no_change
        return entry_of(push, self._computed, self._estimated, 0, n, n, self._window)

    @property
    def displacements(self) -> Floats:
        """Displacements of `LATE_STEPS` ago, (m,). The array is reused."""
        return np.dot(_WINDOW, self._window, out=self._out)

    def reset(self) -> None:
        """Forget the motion."""
        self._computed[:] = 0.0
        self._estimated[:] = 0.0


@kernel
def push(
    computed: Floats, estimated: Floats, then: int, trust: Floats, change: Floats, window: Floats
) -> None:
    """
    Push the smoothed displacements of a step into a window.

    Parameters
    ----------
    computed, estimated
        Displacements of the model, (k, m), and estimated differences from it, (k, n).
    then
        Row of the step.
    trust, change
        Share of the difference that is applied, and what was measured since adds to it, (n,).
    window
        Displacements of some steps, the oldest first, (w, m), written.

    """
    last, m = window.shape[0] - 1, window.shape[1]
    for k in range(last):
        for i in range(m):
            window[k, i] = window[k + 1, i]
    for i in range(m):
        window[last, i] = computed[then, i]
    for i in range(len(trust)):
        window[last, i] += trust[i] * (estimated[then, i] + change[i])


def push_in_numpy(
    computed: Floats, estimated: Floats, then: int, trust: Floats, change: Floats, window: Floats
) -> None:
    """Push the smoothed displacements of a step into a window as `push`."""
    window[:-1] = window[1:]
    window[-1] = computed[then]
    window[-1, : len(trust)] += trust * (estimated[then] + change)
