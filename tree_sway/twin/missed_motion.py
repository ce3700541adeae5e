# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
What a sensor measures that the coordinates of a filter cannot have.

A limb has more modes than a filter, and leans by wood and leaves that are not those of its model.
By the noise of its samples alone, all of that would be taken for sway of the whole tree. Its
innovations tell how much there is of it: ``R = C - H P H'``, C their covariance (Mehra 1970, IEEE
Transactions on Automatic Control 15, 175-184).
"""

from __future__ import annotations

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.twin.estimate import Estimate
from tree_sway.twin.steady_filter import steady_filter, SwayLaw

_ROUNDS = 2
"""How often gains and noise are found by each other, from the noise that was found before."""

_SETTLED = 0.25
"""Share of a record in which a filter settles."""

_PARTS = 15
"""Parts of a record whose squares are compared."""

_MOST = 2.0
"""Largest mean of the squares over their median, so that a push or a knock counts little."""

_LEAST = 300
"""Number of measurements from which on the noise is found by them."""


def missed_noise(
    law: SwayLaw, sensed: Floats, least: Floats, before: Floats, measured: Floats
) -> Floats:
    """
    Find the noise for which the innovations of one sensor are as large as a filter expects.

    Parameters
    ----------
    law
        How the state moves.
    sensed
        Measurements by the state, three axes of each quantity, (p, 3 m).
    least
        Standard deviation of the noise of its samples, (p,).
    before
        What was found before, to begin from, or the least again, (p,).
    measured
        Measurements at equal steps of the law, the oldest first, (n, p); rows with one that is
        not finite are left out.

    Returns
    -------
    Floats
        Standard deviation of each measurement, (p,), the same for the three axes of a quantity
        beyond the least; `before` where there are few measurements.

    """
    noise = np.maximum(before, least)
    measured = measured[np.isfinite(measured).all(axis=1)]
    if len(measured) < _LEAST:
        return noise
    settling, settled = np.split(measured, [round(_SETTLED * len(measured))])
    for _ in range(_ROUNDS):
        gains = steady_filter(law, sensed, noise)
        estimate = Estimate(gains, np.zeros(len(sensed), dtype=np.int64))
        estimate.tried(settling)
        parts = [estimate.tried(part) for part in np.array_split(settled, _PARTS)]
        squares = np.minimum(np.mean(parts, axis=0), _MOST * np.median(parts, axis=0))
        larger = squares - np.square(gains.deviation)
        of_quantity = larger.reshape(-1, 3).mean(axis=1).repeat(3)
        noise = np.sqrt(np.maximum(np.square(noise) + of_quantity, np.square(least)))
    return noise
