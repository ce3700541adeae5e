# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
How much later than at the anemometer gusts reach the tree, from the motion of a sensor.

Turbulence moves with the mean wind and changes little on the way (Taylor 1938, Proceedings of the
Royal Society A 164, 476-490): the tree moves as the model did in the wind of some seconds before.
Of all lags, the right one has the largest correlation of sensor and model over all ways in which
the sensor may be mounted, the sum of the singular values of their covariance (Wahba 1965, SIAM
Review 7, 409).
"""

from __future__ import annotations

from collections.abc import Sequence
import math
from typing import NamedTuple

import numpy as np

from tree_sway.core.arrays import Floats, Ints

_LIKE, _BY_CHANCE = 0.33, 2.4
"""
Least correlation at a lag that is believed, and that over the one of a single period of sway.

Motions of some periods resemble each other by chance, by the root of their number.
"""

_OVER_OTHERS = 1.3
"""Least correlation at a lag over that at lags of a period of sway or more beside it."""

_OVER_PRESENT = 2.0
"""
Least correlation over that without a lag, where both are a period of sway or more apart.

A softer tree resembles its model a period later too. Where the wind comes late, the present one
resembles it by chance only.
"""

_LEAST_OVERLAP = 0.5
"""Least share of the samples that are compared at a lag."""


class WindLag(NamedTuple):
    """
    A lag in steps; the correlation at it, the largest one beside it, and that without a lag.

    ``period`` is the number of steps in a period of sway, ``n_periods`` how many are compared.
    """

    steps: int
    likeness: float
    beside: float
    present: float
    period: int
    n_periods: float

    @property
    def is_sure(self) -> bool:
        """Whether the lag is believed."""
        if abs(self.steps) >= self.period and self.likeness < _OVER_PRESENT * self.present:
            return False
        chance = _BY_CHANCE / math.sqrt(max(self.n_periods, 1.0))
        return self.likeness > max(_LIKE, chance, _OVER_OTHERS * self.beside)


def find_lag(
    pairs: Sequence[tuple[Floats, Floats]], least: int, most: int, period: int
) -> WindLag:
    """
    Find by how many steps a sensor is behind a model.

    Parameters
    ----------
    pairs
        Motion of the sensor, in any frame, and of the model, (n, 3) each, of every quantity that
        is measured.
    least, most
        Smallest and largest lag in steps, at most 0 and at least 0.
    period
        Steps in a period of sway: lags closer to each other count as one.

    """
    n = len(pairs[0][0])
    size = 2 ** (2 * n - 2).bit_length()  # of all products without a wrap
    least, most = max(least, -round(_LEAST_OVERLAP * n)), min(most, round(_LEAST_OVERLAP * n))
    lags = np.arange(least, most + 1)
    covariance = np.zeros((len(lags), 3, 3))
    own, other = np.zeros((2, len(lags)))
    for sensed, model in pairs:
        moved, wanted = _of_size_one(sensed), _of_size_one(model)
        waves = np.fft.rfft(moved, size, axis=0)[:, :, None]
        products = np.fft.irfft(
            waves * np.fft.rfft(wanted[::-1], size, axis=0)[:, None], size, axis=0
        )
        covariance += products[n - 1 + lags]
        own += _sums(np.square(moved).sum(axis=1), lags)
        other += _sums(np.square(wanted).sum(axis=1), -lags)
    values = np.linalg.svd(covariance, compute_uv=False).sum(axis=1)
    likeness = values / np.sqrt(np.maximum(own * other, 1e-300))
    best = np.argmax(likeness)
    apart = np.abs(lags - lags[best]) >= period
    beside = likeness[apart].max(initial=0.0)
    present = likeness[np.searchsorted(lags, 0)]
    return WindLag(int(lags[best]), likeness[best], beside, present, period, n / period)


def _of_size_one(rows: Floats) -> Floats:
    """Motion (n, 3) about its mean, over its root mean square."""
    beyond = rows - rows.mean(axis=0)
    return beyond / max(beyond.std(), 1e-300)


def _sums(squares: Floats, lags: Ints) -> Floats:
    """Sum the squares (n,) of a motion that are compared with an earlier one, at each lag."""
    sums = np.concatenate([[0.0], np.cumsum(squares)])
    last = len(squares) - np.maximum(-lags, 0)
    return sums[last] - sums[np.maximum(lags, 0)]
