# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The wind to come, which the page draws."""

from __future__ import annotations

import math

from tree_sway.simulation import WindSource
from tree_sway.stream import Json

_COUNT, _EVERY = 20, 0.5
"""Number of speeds, and time between them [s]."""

_LONGEST = 10.0
"""Time within which a sample of the wind is looked for [s]."""


def wind_ahead(wind: WindSource, now: float) -> Json:
    """
    Speeds to come, for viewers: the time ``every`` between them [s], and ``speeds`` [m/s].

    They are of a source that knows what is to come: a simulated or a recorded wind.
    """
    times = (now + _EVERY * i for i in range(_COUNT))
    samples = (next(wind.between(time, time + _LONGEST), None) for time in times)
    speeds = [round(math.hypot(*sample[1]), 2) for sample in samples if sample is not None]
    return {'every': _EVERY, 'speeds': speeds}
