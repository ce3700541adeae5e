# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Wind between samples that are means over minutes or hours.

A gap of seconds in a sensor's samples is a fault, after which the wind decays. Means are further
apart: between them the wind is on a straight line from one to the next.
"""

from __future__ import annotations

import math

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.simulation.wind import LEAST_INTERVAL

_SPACING = 10.0
_MOST = 1_000_000


def interpolated_means(time: Floats, velocity: Floats) -> tuple[Floats, Floats]:
    """
    Return samples on straight lines between means, some 10 s apart.

    Parameters
    ----------
    time, velocity
        Time of each sample in [s], increasing, (n,), and velocity in [m/s], (n, 3).

    Returns
    -------
    tuple
        Times [s], (m,), and velocities [m/s], (m, 3): those of the arguments if their median
        spacing is shorter than `LEAST_INTERVAL`. Of a record of many months they are further
        apart, so that there are no more than a million.

    """
    if len(time) < 2:
        return time, velocity
    period = float(np.median(np.diff(time)))
    if period < LEAST_INTERVAL:
        return time, velocity
    duration = float(time[-1] - time[0])
    least = duration / _MOST
    # A fraction of the period, so that the means themselves are among the samples.
    parts = min(math.ceil(period / _SPACING), math.floor(period / least))
    spacing = max(period / max(parts, 1), least)
    fine = time[0] + spacing * np.arange(math.floor(duration / spacing + 1e-9) + 1)
    return fine, np.stack([np.interp(fine, time, column) for column in velocity.T], axis=1)
