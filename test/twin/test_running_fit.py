# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A fit of hours is by the air of those hours, weighted by their motion, and not by the last."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from tree_sway.twin.late_wind import LateWind
from tree_sway.twin.motion_sensor import MotionSensor
from tree_sway.twin.running_fit import RunningFit
from tree_sway.twin.sensor_place import PlaceMotion, SensorPlace
from tree_sway.twin.sensor_track import SensorTrack

N, DT = 3, 1.0 / 60.0


def test_air_and_forces_are_weighted_by_the_motion_of_their_stretches() -> None:
    forces = SimpleNamespace(speed=8.0, air_damping=np.full(N, 0.8), covariance=2.0 * np.eye(N))
    unknown: Any = SimpleNamespace(
        count=N, all_stiffness=np.ones(N), all_damping=np.ones(N), forces=forces, mean_speed=8.0,
        frequency=1.0, dt=DT,
    )  # fmt: skip
    track = SensorTrack(MotionSensor('s', SensorPlace(0, 0.5)), 1.0, DT)
    track.motion = PlaceMotion(*np.zeros((2, 3, N)))
    track.uses = (0, 1)
    fit = RunningFit(unknown, [track])
    filled = 0
    for speed, power in ((8.0, 90.0), (2.0, 10.0)):
        unknown.mean_speed = speed
        for step in range(2):
            spectrum = fit._spectra[0]
            filled += 1
            spectrum.native.filled = filled
            spectrum.count += step
            spectrum._power[0] += step * power
            fit.note(speed, 0.0)
    assert fit._weight == pytest.approx(100.0)
    np.testing.assert_allclose(fit._air / fit._weight, 0.9 * 0.8 + 0.1 * 0.2)
    np.testing.assert_allclose(fit._forces / fit._weight, np.eye(N) / N)


def test_forces_of_a_wind_that_is_known_late_are_compared_as_if_they_had_come_in_time() -> None:
    unknown: Any = SimpleNamespace(
        count=N, all_stiffness=np.ones(N), all_damping=np.ones(N), frequency=1.0, dt=DT
    )
    track = SensorTrack(MotionSensor('s', SensorPlace(0, 0.5)), 1.0, DT)
    track.motion = PlaceMotion(*np.zeros((2, 3, N)))
    track.uses = (0, 1)
    wind = LateWind()
    fit = RunningFit(unknown, [track], wind)
    fit.note(0.0, 0.0)
    measured = fit._spectra[0]
    late, rng = 0.3, np.random.default_rng(0)
    series = rng.normal(size=(5 * measured._half, N + 4))
    steps = round(late / DT)
    series[steps:, 2 : 2 + N] = series[:-steps, :1]  # forces as the motion to the east, but late
    rows = measured._series.reshape(-1, N + 4)
    for row in series:
        rows[measured.native.filled % len(rows)] = row
        measured.native.filled += 1
        measured.advance()
    wind.known_late = late
    of_motion = fit._spectrum(0).products[:, 2:, 0]
    assert measured.count > 0
    assert np.abs(np.angle(of_motion)).max() < 0.3
