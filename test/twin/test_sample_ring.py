# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The ring of samples reads as numpy does from the whole record, and its memory is bounded."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tree_sway.twin.sample_ring import CAPACITY, SampleRing

DT = 1.0 / 60.0


def test_samples_are_averaged_within_a_step_and_joined_elsewhere() -> None:
    rng = np.random.default_rng(3)
    times = np.cumsum(rng.uniform(0.002, 0.03, 6000))
    times[4000:] += 2.0  # a gap
    values = rng.normal(0.0, 3.0, (6000, 9))
    sample = np.zeros(9)
    ring, asked, kinds = SampleRing(sample), 0.1, set()
    ring.ask_for((True, True, True))
    for now, each in zip(times.tolist(), values, strict=True):
        sample[:] = each
        assert ring.keep(now) == 'accepted'
        while asked < now - DT:
            before = int(np.searchsorted(times, asked)) - 1
            asked = max(asked, times[before] + 0.02 * DT)  # not of the time of a sample
            found = ring.read(asked, DT)
            within = np.abs(times - asked) < 0.5 * DT
            is_gap = times[before + 1] - times[before] > 0.25
            kinds.add((is_gap, within.sum() > 1))
            if within.sum() > 1:
                np.testing.assert_allclose(found, values[within].mean(axis=0), atol=1e-12)
            elif is_gap:
                assert found is None
            else:
                expected = [np.interp(asked, times, column) for column in values.T]
                np.testing.assert_allclose(found, expected, atol=1e-9)
            asked += 0.0171
    assert kinds == {(False, False), (False, True), (True, False)}


def test_the_oldest_samples_make_room() -> None:
    sample = np.zeros(9)
    ring, count = SampleRing(sample), CAPACITY + 100
    ring.ask_for((True, True, True))
    for k in range(count):
        sample[:] = k % 7
        assert ring.keep(float(k)) == 'accepted'
    assert ring.read(99.0, DT) is None
    np.testing.assert_array_equal(ring.read(count - 1.0, DT), (count - 1) % 7)


def test_the_newest_samples_are_those_of_one_clock() -> None:
    sample = np.zeros(9)
    ring = SampleRing(sample)
    assert math.isnan(ring.period)
    assert len(ring.newest_samples()) == 0
    ring.ask_for((True, True, True))
    for k in range(100):
        sample[:] = k
        ring.keep(100.0 + 0.1 * k)
        ring.read(100.0 + 0.1 * k, DT)
    np.testing.assert_array_equal(ring.newest_samples()[:, 0], np.arange(100))
    assert ring.period == pytest.approx(0.1)
    outcomes = list[str]()
    for k in range(10):
        sample[:] = 100 + k
        outcomes.append(ring.keep(50.0 + 0.04 * k))
    first = outcomes.index('restarted')
    np.testing.assert_array_equal(ring.newest_samples()[:, 0], np.arange(100 + first, 110))
    assert ring.period == pytest.approx(0.04)
    ring.ask_for((True, False, False))
    assert len(ring.newest_samples()) == 0


def test_a_gap_is_told_from_the_period_of_the_last_samples() -> None:
    sample = np.zeros(9)
    ring, time = SampleRing(sample), 0.0
    ring.ask_for((True, True, True))
    rng = np.random.default_rng(7)
    for period, most in ((0.01, 0.25), (0.2, 0.8)):
        for _ in range(21):  # most of the last 39 steps are of this period
            time += period
            sample[:] = rng.normal(size=9)
            assert ring.keep(time) == 'accepted'
        assert ring.period == pytest.approx(period)
        for apart, is_gap in ((0.9 * most, False), (1.1 * most, True)):
            before = time
            time += apart
            sample[:] = rng.normal(size=9)
            assert ring.keep(time) == 'accepted'
            assert (ring.read(before + 0.5 * apart, DT) is None) == is_gap
