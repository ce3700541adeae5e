# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Samples of wind without a sensor: simulated, or a repeated record."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
import math
from typing import Protocol

from tree_sway.core.arrays import Floats
from tree_sway.core.scene import Run
from tree_sway.newest import Newest
from tree_sway.simulation.interpolated import interpolated_means
from tree_sway.simulation.wind import AnemometerModel

_RATE = 20.0
Sample = tuple[float, tuple[float, float, float]]
"""Time in [s] and wind in [m/s], the way the air goes."""


class WindSource(Protocol):
    """Samples of wind by their times."""

    @property
    def source(self) -> Mapping[str, object]:
        """
        Source of the wind for viewers: its ``kind``, simulated, recorded or live, and a ``name``.

        A live one has its newest reading and the age of that too.
        """

    def between(self, since: float, until: float) -> Iterator[Sample]:
        """Return the samples after a time up to a later one, both in [s]."""


_BEFORE = 10.0
"""Time in [s] before the first step of a run whose samples it is given."""


def blow(run: Run, wind: WindSource, until: int) -> None:
    """
    Step a run up to a time [ns] with the samples of a source since its last step.

    A run may begin days after the source: it is given the last samples, not all of them.
    """
    since = 1e-9 * until - _BEFORE if run.time is None else 1e-9 * run.time
    for time, velocity in wind.between(since, 1e-9 * until):
        run.offer(round(1e9 * time), velocity)
    run.advance(until)


class SimulatedWind:
    """
    Turbulent wind with a variable mean; the gusts keep their pattern.

    Parameters
    ----------
    speed
        Mean in [m/s].
    intensity
        Standard deviation along the wind over the mean.
    bearing_to
        Direction of the wind, clockwise from north in [rad].
    seed
        Seed of the turbulence.

    """

    def __init__(
        self,
        speed: float = 6.0,
        intensity: float = 0.2,
        bearing_to: float = 0.5 * math.pi,
        seed: int = 0,
    ) -> None:
        self.values = {'mean_speed': speed, 'intensity': intensity, 'bearing_to': bearing_to}
        self.source = {'kind': 'simulated'}
        self._seed = seed
        self._maker = Newest(self._make, 'wind')
        self._make(self.values)

    def set(self, name: str, value: float) -> None:  # noqa: A003
        """
        Change ``mean_speed`` [m/s], ``intensity`` or ``bearing_to`` [rad].

        The new turbulence takes some hundredths of a second, on another thread; until then the
        wind is as before.
        """
        self.values = {**self.values, name: value}
        self._maker.want(self.values)

    def between(self, since: float, until: float) -> Iterator[Sample]:
        """Return the samples after a time up to a later one, both in [s]."""
        model = self._model
        first, end = (max(math.floor(t * _RATE + 1e-6) + 1, 0) for t in (since, until))
        for tick in range(first, end):
            x, y, z = model.sample(tick).tolist()
            yield tick / _RATE, (x, y, z)

    def _make(self, values: Mapping[str, float]) -> None:
        self._model = AnemometerModel(
            values['mean_speed'],
            bearing_to=values['bearing_to'],
            intensity=values['intensity'],
            rate=_RATE,
            seed=self._seed,
        )


class RecordedWind:
    """
    A repeated record.

    Parameters
    ----------
    time
        Time of each sample in [s], increasing, (n,).
    velocity
        Wind, blowing to, in [m/s], (n, 3); interpolated if the samples are means
        (`interpolated_means`).
    name
        Name of the record for viewers.

    """

    def __init__(self, time: Floats, velocity: Floats, name: str = '') -> None:
        self.source = {'kind': 'recorded', 'name': name}
        time, velocity = interpolated_means(time, velocity)
        self._time = time - time[0]
        self._velocity = velocity
        last = float(self._time[-1])
        self.length = last + max(last / max(len(time) - 1, 1), 1e-3)
        self._ahead = 0.0

    def seek(self, time: float, now: float) -> None:
        """Continue from a time of the record, now; both in [s]."""
        self._ahead = time - now

    def time(self, now: float) -> float:
        """Present time of the record; both in [s]."""
        return (now + self._ahead) % self.length

    def between(self, since: float, until: float) -> Iterator[Sample]:
        """Return the samples after a time up to a later one, both in [s]."""
        ahead = self._ahead  # a viewer's thread may seek meanwhile
        since = since + ahead
        until = until + ahead
        lap = max(math.floor(since / self.length), 0)
        n = len(self._time)
        i = int(self._time.searchsorted(since - lap * self.length + 1e-9, 'right'))
        while True:
            lap = lap + i // n
            i = i % n
            time = lap * self.length + float(self._time[i])
            if time > until + 1e-9:
                return
            x, y, z = self._velocity[i].tolist()
            yield time - ahead, (x, y, z)
            i += 1
