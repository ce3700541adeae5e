# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A tree taken through a wind without ROS, as fast as the machine can."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from tree_sway_ros.core.arrays import Floats
from tree_sway_ros.core.simulator.protocol import Simulator
from tree_sway_ros.core.wind.averaging import WindAverage
from tree_sway_ros.core.wind.simulated.anemometer import AnemometerModel
from tree_sway_ros.files.wind.record import WindRecord
from tree_sway_ros.tools.progress import bar

Samples = Iterator[tuple[float, Floats]]


@dataclass(frozen=True)
class Sway:
    """
    What happened, one row per step.

    Parameters
    ----------
    time
        End of each step in [s], (n,).
    wind
        Mean wind over the step in [m/s], (n, 3).
    tip
        Displacement of the highest tip from rest in [m], (n, 3).

    """

    time: Floats
    wind: Floats
    tip: Floats


def recorded(record: WindRecord) -> Samples:
    """Samples of a record: time in [s] and velocity in [m/s], (3,)."""
    yield from zip(record.time.tolist(), record.velocity, strict=True)


def simulated(model: AnemometerModel) -> Samples:
    """Samples of a simulated anemometer, without end."""
    for tick in itertools.count():
        yield tick / model.rate, model.sample(tick)


def sway_in_wind(
    simulator: Simulator, samples: Samples, seconds: float, rate: float = 60.0
) -> Sway:
    """
    Take a tree through a wind.

    Parameters
    ----------
    simulator
        The tree; goes on from the state it is in.
    samples
        Time in [s] and velocity in [m/s], rising in time; ends when they end.
    seconds
        Ends after so long at the latest [s].
    rate
        Steps per second in [Hz].

    Returns
    -------
    Sway
        Time, wind and tip.

    """
    average = WindAverage()
    dt = 1.0 / rate
    time, wind, tip = [], [], []
    coming = next(samples, None)
    for step in bar(range(round(seconds * rate)), "swaying"):
        begin, end = step * dt, (step + 1) * dt
        while coming is not None and coming[0] <= end:
            average.add(*coming)
            coming = next(samples, None)
        if coming is None:
            break
        mean = average.mean(begin, end)
        simulator.step(mean, dt)
        simulator.place()
        time.append(end)
        wind.append(np.array(mean))
        tip.append(simulator.tip_displacement)
    return Sway(np.array(time), np.array(wind).reshape(-1, 3), np.array(tip).reshape(-1, 3))
