# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A simulated anemometer: mean wind, turbulence and events, sampled tick by tick without end."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.checks import within
from tree_sway.core.wind.simulated.gust_event import GustEvent, with_events
from tree_sway.core.wind.simulated.turbulence import along_bearing, Turbulence
from tree_sway.core.wind.simulated.turbulence_stream import TurbulenceStream


class AnemometerModel:
    """
    The wind that an anemometer reads, a pure function of its parameters, seed and tick.

    Parameters
    ----------
    mean_speed
        Mean wind speed in [m/s], 0 to 40; a mean of 0 has no turbulence.
    bearing_to
        Where the mean wind blows to, clockwise from north in [rad]; the default is a westerly.
    turbulence
        ``kaimal``, ``von_karman`` or ``none``.
    height, intensity
        As in `Turbulence`.
    rate
        Samples per second in [Hz], 1 to 100.
    events
        Gusts, steps and turns, timed from tick 0.
    seed
        Seed of the turbulence. Under one seed the gusts keep their pattern when speed or intensity
        change, so that a live change makes no jump but its own.

    Raises
    ------
    ParameterError
        If a value is out of its range.

    """

    def __init__(
        self,
        mean_speed: float = 5.0,
        *,
        bearing_to: float = 0.5 * np.pi,
        turbulence: str = 'kaimal',
        height: float = 10.0,
        intensity: float | None = None,
        rate: float = 20.0,
        events: Sequence[GustEvent] = (),
        seed: int = 0,
    ) -> None:
        """Check the parameters."""
        within('mean_speed', mean_speed, 0.0, 40.0, 'm/s')
        self.rate = within('rate', rate, 1.0, 100.0, 'Hz')
        """Samples per second in [Hz]."""
        self._bearing_to = within('bearing_to', bearing_to, -1e3, 1e3, 'rad')
        self._events = tuple(events)
        self._mean = np.array([mean_speed, 0.0, 0.0])
        self._stream: TurbulenceStream | None = None
        if turbulence != 'none':
            level = mean_speed or 1.0
            parameters = Turbulence(level, turbulence, height, intensity)
            if mean_speed > 0.0:
                self._stream = TurbulenceStream(parameters, rate, seed)

    def sample(self, tick: int) -> Floats:
        """Wind at a tick of the sample period from 0 on: blowing to, ENU in [m/s], (3,)."""
        within('tick', tick, 0, 2**63)
        wind = self._mean if self._stream is None else self._mean + self._stream.at(tick)
        enu = along_bearing(wind, self._bearing_to)
        if not self._events:
            return enu
        return with_events(tick / self.rate, enu, self._events, self._bearing_to)
