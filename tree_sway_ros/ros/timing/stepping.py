# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
From ticks to steps: each period of the grid is solved with the mean wind over that very period.

A sample of the wind is handed on when the steps reach its time, not when it arrives: as long as it
arrives within `wind_delay`, a run over the same record gives the same numbers, whatever the
network did.

A late tick stands for several periods. They are solved one by one, so that lateness leaves no
trace in the motion; only where a step costs more than half a period are they joined to one long
step, which the exact propagator takes without harm, so that a slow machine never falls further
behind.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
import time

from numpy.typing import ArrayLike

from tree_sway_ros.core.arrays import Floats
from tree_sway_ros.core.simulator.protocol import Simulator
from tree_sway_ros.core.wind.averaging import WindAverage

_BLOCK = 10_000_000_000_000
"""
Times are counted in seconds from a whole multiple of this [ns]: short numbers, the same in every
run.

"""
_QUEUE = 4096
_WARM_FRAMES = 20
# Weight of the newest step in the running mean of its cost.
_NEWEST = 0.02


class Stepper:
    """
    Steps a simulator through the wind on a grid of a period [ns].

    ``make_wind`` makes an empty `WindAverage`; it is called again whenever the clock was set back.
    """

    def __init__(
        self, simulator: Simulator, make_wind: Callable[[], WindAverage], period: int
    ) -> None:
        self.simulator = simulator
        self.is_paused = False
        self._make_wind = make_wind
        self._wind = make_wind()
        self._period = period
        self._samples: deque[tuple[int, ArrayLike]] = deque(maxlen=_QUEUE)
        self._requests: deque[Callable[[], None]] = deque(maxlen=_QUEUE)
        self._origin = 0
        self._felt = 0.0
        self._cost = 0.0
        self.wind_state = 'none'
        """What the wind is: none, live, holding, decaying or stale, as `WindAverage.state`."""

    def warm_up(self) -> float:
        """Have kernels compiled or loaded ahead; return what a frame takes in [us]."""
        wind = self._make_wind()
        wind.add(0.0, (1.0, 0.0, 0.0))
        period = self._period * 1e-9
        mean, spent = wind.mean(-period, 0.0), []
        for _ in range(_WARM_FRAMES):
            begin = time.perf_counter()
            self.simulator.step(mean, period)
            self.simulator.place()
            spent.append(time.perf_counter() - begin)
        self.simulator.reset()
        return 1e6 * min(spent)

    def add_wind(self, time_ns: int, vector: ArrayLike) -> None:
        """Take a sample of the wind; any thread may call this."""
        self._samples.append((time_ns, vector))

    def request(self, action: Callable[[], None]) -> None:
        """Have something done before the next step, in its thread."""
        self._requests.append(action)

    def restart(self, time_ns: int) -> None:
        """Begin at a time: forget the wind and the motion."""
        self._origin = time_ns // _BLOCK * _BLOCK
        self._wind = self._make_wind()
        self._samples.clear()
        self.simulator.reset()

    def advance(self, time_ns: int, periods: int, delay: float, *, may_join: bool = True) -> None:
        """
        Solve so many periods up to a time [ns], with the wind felt later by a delay [s].

        Periods may be joined to one step, unless a replay is to be exact.
        """
        while self._requests:
            self._requests.popleft()()
        n_steps = 1 if may_join and self._cost > 0.5e-9 * self._period else periods
        step_ns = self._period * periods // n_steps  # whole numbers: the same dt at any lateness
        dt = step_ns * 1e-9
        for later in range(n_steps - 1, -1, -1):
            self._felt = self._seconds(time_ns - later * step_ns) - delay
            wind = self._mean_wind(self._felt, dt)
            if not self.is_paused:
                begin = time.perf_counter()
                self.simulator.step(wind, dt)
                self._cost += _NEWEST * (time.perf_counter() - begin - self._cost)
        # Asked for here, in the thread that changes it: reports come from another.
        self.wind_state = str(self._wind.state(self._felt))

    def _mean_wind(self, end: float, dt: float) -> Floats:
        samples = self._samples
        while samples and self._seconds(samples[0][0]) <= end:
            time_ns, vector = samples.popleft()
            self._wind.add(self._seconds(time_ns), vector)
        return self._wind.mean(end - dt, end)

    def _seconds(self, time_ns: int) -> float:
        return (time_ns - self._origin) * 1e-9


class Divider:
    """Tells when the next frame is due, where only some of the ticks make one."""

    def __init__(self) -> None:
        self._last: int | None = None

    def is_due(self, index: int, every: int) -> bool:
        """Whether tick `index` is the first in its group of `every` ticks."""
        group = index // every
        due = group != self._last
        self._last = group
        return due
