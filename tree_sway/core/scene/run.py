# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A scene in a live wind: samples pass the gate, steps are on a grid of time.

Steps end at whole multiples of the period since the clock's epoch, and each is solved with the
mean wind over that very period. A sample is used when the steps reach its time, not when it
arrives: if it arrives before, runs over the same samples have the same steps, whatever the network
did. While samples are overdue the last one is used, then the wind decays (`WindAverage`).

Late periods are solved one by one, so that lateness does not change the motion; only where a step
costs more than half a period may they be joined to one long step, for which the propagator is
exact. Jumps of the clock beyond `LONGEST_JUMP` are skipped and counted. The caller has the clock:
times are whole nanoseconds of one clock.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
import math
from typing import Any

from numpy.typing import ArrayLike

from tree_sway.core.arrays import Floats
from tree_sway.core.checks import LONGEST_STEP
from tree_sway.core.scene.scene_simulator import Simulator
from tree_sway.core.wind import GateCounts, GoodWind, WindAverage, WindIntake
from tree_sway.errors import TreeSwayError

LONGEST_JUMP = round(1e9 * LONGEST_STEP)
"""Longest time that one `Run.advance` solves [ns]; time before it is skipped."""

_BACK = 1_000_000_000
"""Step back of the clock in [ns] after which the run restarts."""

_BLOCK = 10_000_000_000_000
"""Times in seconds are relative to a multiple of this [ns]: few digits, the same in every run."""

_QUEUE = 4096
_EARLIEST = 0.9  # of the period of a sensor, after which its next sample is expected
_PULL_LASTS = 0.5
_LONGEST_REASON = 400
_NEWEST = 0.02  # weight of the newest step in the running mean of its cost

_Refused = Callable[[str], object]
"""Function called with the reason why a request is refused."""


class Run:
    """
    Steps a scene through a live wind; used from one thread, but for `offer` and `request`.

    Parameters
    ----------
    simulator
        The simulator of a tree or a scene.
    rate
        Steps per second in [Hz].
    intake
        Intake that samples pass; by default a `WindGate` as in the wind node.
    make_wind
        Function that makes an empty `WindAverage`; called again whenever the clock was set back.
    stepped
        Function called after each step with its end [ns] and its mean wind [m/s], (3,).
    starting
        Function called before each step with its end, less the delay that was asked for, and by
        how much its wind is later than that, both [s].
    timer
        Clock in [s] to measure the cost of a step; None to never join steps.

    """

    def __init__(
        self,
        simulator: Simulator,
        rate: float = 60.0,
        *,
        intake: WindIntake | None = None,
        make_wind: Callable[[], WindAverage] = WindAverage,
        stepped: Callable[[int, Floats], object] = lambda end, wind: None,
        starting: Callable[[float, float], object] = lambda end, late: None,
        timer: Callable[[], float] | None = None,
    ) -> None:
        self.simulator = simulator
        self.period = round(1e9 / rate)
        self.intake = WindIntake() if intake is None else intake
        self.counts: GateCounts = self.intake.counts
        """Counts of accepted and refused samples, by reason."""
        self.is_paused = False
        self.clamped = 0
        """Number of forward jumps that were cut to `LONGEST_JUMP`."""
        self.refused_requests = 0
        """Number of requests that failed, and changed nothing."""
        self.wind_state = 'none'
        """State of the wind: none, live, holding, decaying or stale, as `WindAverage.state`."""
        self.late = 0
        """Number of samples that arrived after the step of their time, since the last restart."""
        self.newest: int | None = None
        """Time of the newest sample in [ns]; None before any."""
        self._make_wind = make_wind
        self._stepped = stepped
        self._timer = timer
        self._starting = starting
        self._wind = make_wind()
        self._samples: deque[GoodWind] = deque(maxlen=_QUEUE)
        self._requests: deque[tuple[Callable[[], object], _Refused]] = deque(maxlen=_QUEUE)
        self._index: int | None = None
        self._origin = 0
        self._felt = -math.inf
        self._cost = 0.0

    @property
    def is_wind_lost(self) -> bool:
        """Whether no sample is in use: none yet, or the last one is older than its time-out."""
        return self.wind_state == 'none' or self.is_wind_silent

    @property
    def is_wind_silent(self) -> bool:
        """Whether there was wind, and its last sample is older than its time-out."""
        return self.wind_state in ('decaying', 'stale')

    @property
    def time(self) -> int | None:
        """End of the last step in [ns]; None before the first."""
        return None if self._index is None else self._index * self.period

    def offer(
        self,
        stamp: int,
        components: tuple[float, float, float],
        arrival: int | None = None,
        **how: Any,
    ) -> GoodWind | None:
        """Check a sample as `WindIntake.offer`; returns it if accepted, else None."""
        good = self.intake.offer(stamp, components, arrival, **how)
        if good is not None:
            is_late = self._index is not None and self._seconds(good.time) <= self._felt
            self.late += is_late
            self._samples.append(good)
            self.newest = good.time
        return good

    def lacks_wind(self, to: int, *, delay: float = 0.0) -> bool:
        """
        Whether the next sample of a sensor acts before a time, and has not arrived.

        It is expected a period of the sensor after the last one, where that is known.

        Parameters
        ----------
        to
            End of the step in [ns].
        delay
            Delay of the wind in [s], as for `advance`.

        """
        if self.newest is None:
            return False
        period = self._wind.period or 0.0
        expected = self._seconds(self.newest) + self._wind.lateness + _EARLIEST * period
        return self._seconds(to) - delay >= expected

    def request(
        self, action: Callable[[], object], refused: _Refused = lambda reason: None
    ) -> None:
        """
        Call a function before the next step, in its thread.

        Parameters
        ----------
        action
            The function. If it raises an error, the steps continue, and the error is counted in
            `refused_requests`.
        refused
            Function called with the text of that error, from the thread of the steps.

        """
        self._requests.append((action, refused))

    def pull(self, segment: int, to: ArrayLike, stiffness: float, refused: _Refused) -> None:
        """
        Pull at a segment by a spring before the next step, for half a second unless repeated.

        Parameters
        ----------
        segment
            Row of the segment in the pose block.
        to
            Target place in [m], (3,).
        stiffness
            Stiffness of the spring in [N/m]; 0 releases it.
        refused
            Function called with the reason of a refusal, from the thread of the steps.

        """
        from tree_sway.core.run import Spring

        def push() -> None:
            force = Spring(to, stiffness) if stiffness else (0.0, 0.0, 0.0)
            self.simulator.push(segment, force, _PULL_LASTS if stiffness else 1e-9, along=0.0)

        self.request(push, refused)

    def restart(self, time: int) -> None:
        """Begin at a time [ns]: forget the wind and the motion."""
        self._begin(time)
        self._wind = self._make_wind()
        self._samples.clear()
        self.newest = None
        self.late = 0
        self._felt = -math.inf
        self.intake.gate.reset()
        self.simulator.reset()

    def advance(
        self, to: int, *, delay: float = 0.0, most: int | None = None, may_join: bool = True
    ) -> int:
        """
        Solve every step that ends by a time.

        Parameters
        ----------
        to
            The time in [ns].
        delay
            Delay of the wind in [s]; negative where later samples are known.
        most
            Largest number of periods that are solved, the last ones; by `LONGEST_JUMP` if None.
        may_join
            Whether expensive steps may be joined to a long one.

        Returns
        -------
        int
            Number of periods that were solved.

        """
        while self._requests:
            self._fulfil(*self._requests.popleft())
        if self._index is None:
            self._begin(to)
        elif to < self._index * self.period - _BACK:
            self.restart(to)
        index = to // self.period
        limit = most or max(1, LONGEST_JUMP // self.period)
        passed = index - (self._index or 0)
        if passed <= 0:
            return 0
        self.clamped += passed > limit
        periods = min(passed, limit)
        self._index = index
        n_steps = periods
        if may_join and self._cost > 0.5e-9 * self.period:  # each no longer than a step may be
            n_steps = -(-periods * self.period // LONGEST_JUMP)
        length = self.period * periods // n_steps  # whole numbers: the same dt at any lateness
        dt = length * 1e-9
        for later in range(n_steps - 1, -1, -1):
            self._step(index * self.period - later * length, dt, delay)
        # Read here, in the thread that changes it: reports are made in a different one.
        self.wind_state = self._wind.state(self._felt)
        return periods

    def step(self, wind: Floats) -> None:
        """Solve the next step in a known mean wind (3,) in [m/s], without the samples."""
        self._index = 1 if self._index is None else self._index + 1
        self._solve(self._index * self.period, wind, self.period * 1e-9)

    def _fulfil(self, action: Callable[[], object], refused: _Refused) -> None:
        """Call a requested function; an error of it must not end the steps."""
        try:
            action()
        except TreeSwayError as error:
            reason = str(error)
        except Exception as error:
            reason = f'it failed ({type(error).__name__}: {error})'
        else:
            return
        self.refused_requests += 1
        refused(reason[:_LONGEST_REASON])

    def _begin(self, time: int) -> None:
        self._index = time // self.period - 1
        self._origin = time // _BLOCK * _BLOCK

    def _step(self, end: int, dt: float, delay: float) -> None:
        self._felt = self._seconds(end) - delay
        samples = self._samples
        while samples and self._seconds(samples[0].time) <= self._felt:
            time, velocity = samples.popleft()
            self._wind.add(self._seconds(time), velocity)
        wind = self._wind.mean(self._felt - dt, self._felt)
        if not self.is_paused:
            # A sample acts a period later, when the next is known.
            behind = self._wind.lateness + (self._wind.period or 0.0)
            self._starting(end * 1e-9 - delay, behind)
            self._solve(end, wind, dt)

    def _solve(self, end: int, wind: Floats, dt: float) -> None:
        begin = self._timer() if self._timer is not None else 0.0
        self.simulator.step(wind, dt)
        if self._timer is not None:
            self._cost += _NEWEST * (self._timer() - begin - self._cost)
        self._stepped(end, wind)

    def _seconds(self, time: int) -> float:
        return (time - self._origin) * 1e-9
