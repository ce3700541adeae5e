# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The share of a motion that the wind explains, against closed forms; the lateness of sensors."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tree_sway.core.observe.explained_motion import ExplainedMotion
from tree_sway.core.observe.lateness import Lateness

DT = 1.0 / 60.0


@pytest.mark.parametrize('size', [0.0, 0.3, 0.8, 2.0])
def test_the_share_is_one_less_the_energy_of_the_correction(size: float) -> None:
    explained, stiffness = ExplainedMotion(), np.array([4.0, 100.0])
    for k in range(200 * 60):
        # A lean that stays is no motion, whoever tells of it.
        swing = np.array([math.sin(1.3 * k * DT), 0.2 * math.cos(2.1 * k * DT)])
        explained.note(DT, stiffness, swing + 5.0, size * swing - 3.0)
    assert explained.share == pytest.approx(max(1.0 - size**2, 0.0), abs=0.01)


def lateness_of(arrivals: list[tuple[float, float]], seconds: float) -> int:
    """Return the steps by which a sensor is read late; arrivals are (when, stamp), both in [s]."""
    lateness, newest, k = Lateness(1, DT, 30), -math.inf, 0
    for step in range(round(seconds / DT)):
        time = step * DT
        while k < len(arrivals) and arrivals[k][0] <= time:
            newest = arrivals[k][1]
            k += 1
        lateness.note(0, time, newest)
        lateness.settle(time)
    return lateness.steps


@pytest.mark.parametrize(('delay', 'every'), [(0.0, 0.01), (0.04, 0.01), (0.1, 0.05), (0.2, 0.1)])
def test_sensors_are_read_when_their_samples_are_there(delay: float, every: float) -> None:
    arrivals = [(k * every + delay, k * every) for k in range(round(10.0 / every))]
    found = lateness_of(arrivals, 10.0) * DT
    assert delay + every - DT <= found + 1e-9
    assert found <= delay + every + 1.5 * DT


def test_silence_and_a_stall_leave_the_lateness() -> None:
    arrivals = [(0.01 * k + 0.02, 0.01 * k) for k in range(1000)]
    usual = lateness_of(arrivals, 10.0)
    assert lateness_of(arrivals, 30.0) == usual
    stalled = [(9.0 if 8.6 < at < 9.0 else at, stamp) for at, stamp in arrivals]
    assert lateness_of(stalled, 10.0) <= usual + 7


def test_samples_known_ahead_need_no_lateness() -> None:
    assert lateness_of([(0.01 * k, 0.01 * k + 0.5) for k in range(1000)], 10.0) == 0
