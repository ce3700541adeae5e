# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Samples of sensors as they come: refused with a count, or read at any time."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tree_sway.twin.motion_sensor import MotionSensor
from tree_sway.twin.sensor_place import SensorPlace

PLACE = SensorPlace(0, 0.5)
UP = (0.0, 0.0, 9.81)


def sensor() -> MotionSensor:
    return MotionSensor('phone', PLACE)


def test_samples_are_joined_by_lines() -> None:
    phone = sensor()
    for k in range(5):
        assert phone.offer(0.04 * k, acceleration=(k, 0.0, 9.81))
    found = phone.ring.read(0.05, 1.0 / 60.0)
    assert found is not None
    np.testing.assert_allclose(found[:3], [1.25, 0.0, 9.81])
    assert np.isnan(found[3:]).all()


def test_samples_within_a_step_are_averaged() -> None:
    phone = sensor()
    for k in range(100):
        phone.offer(0.005 * k, rate=(k, 0.0, 0.0))
    found = phone.ring.read(0.1, 0.02)
    assert found is not None
    assert found[3] == pytest.approx(20.5)


def test_nothing_is_read_across_a_gap() -> None:
    phone = sensor()
    for time in (0.0, 0.01, 0.02, 2.0, 2.01):
        phone.offer(time, acceleration=UP)
    assert phone.ring.read(1.0, 1.0 / 60.0) is None
    assert phone.ring.read(3.0, 1.0 / 60.0) is None


@pytest.mark.parametrize(
    ('reason', 'acceleration'),
    [
        ('not_finite', (math.nan, 0.0, 0.0)),
        ('not_finite', (math.inf, 0.0, 0.0)),
        ('not_finite', 'up'),
        ('not_finite', (1.0, 2.0)),
        ('not_finite', None),
        ('too_large', (1e4, 0.0, 0.0)),
    ],
)
def test_bad_samples_are_refused_and_counted(reason: str, acceleration: object) -> None:
    phone = sensor()
    phone.offer(0.0, acceleration=UP)
    assert not phone.offer(0.1, acceleration=acceleration)  # type: ignore[arg-type]
    assert getattr(phone.counts, reason) == phone.counts.refused == 1
    assert phone.offer(0.2, acceleration=UP)


def test_a_sensor_at_its_limit_is_refused_until_it_moves_again() -> None:
    phone = sensor()
    for k in range(10):
        phone.offer(0.01 * k, acceleration=(19.6, 0.01 * k, 9.81))
    assert phone.counts.saturated == 7
    assert phone.offer(0.2, acceleration=(3.0, 0.0, 9.81))


def test_a_sensor_at_rest_is_not_at_its_limit() -> None:
    phone = sensor()
    assert all(phone.offer(0.01 * k, acceleration=UP) for k in range(10))


def test_a_sample_of_the_past_is_refused_and_a_new_clock_accepted() -> None:
    phone = sensor()
    for k in range(10):
        phone.offer(100.0 + 0.01 * k, acceleration=UP)
    assert not phone.offer(100.05, acceleration=UP)
    assert phone.counts.out_of_order == 1
    for k in range(10):
        phone.offer(3.0 + 0.01 * k, acceleration=UP)
    assert phone.counts.restarted == 1
    assert phone.ring.newest == pytest.approx(3.09)


def test_orientations_are_rotations_in_the_frame_of_the_sensor() -> None:
    phone = sensor()
    first = Rotation.from_euler('xyz', [40.0, -70.0, 110.0], degrees=True)
    turned = first * Rotation.from_rotvec([0.03, 0.0, -0.01])
    phone.offer(0.0, orientation=first.as_quat())
    phone.offer(0.01, orientation=turned.as_quat())
    found = phone.ring.read(0.01, 0.001)
    assert found is not None
    np.testing.assert_allclose(found[6:], [0.03, 0.0, -0.01], atol=1e-9)


def test_the_reason_of_most_refusals_is_told() -> None:
    phone = sensor()
    assert not phone.offer(0.0, acceleration=(math.nan, 0.0, 9.8))
    for k in range(2):
        assert not phone.offer(0.01 * k, acceleration=(0.0, 0.0, 1000.0))
    assert 'give m/s^2 or g' in phone.counts.why_refused


def test_an_orientation_of_zeros_is_not_measured() -> None:
    phone = sensor()
    for k in range(5):
        assert phone.offer(0.01 * k, rate=(0.1, 0.0, k), orientation=(0.0, 0.0, 0.0, 0.0))
    assert phone.quantities == ('rate',)


def test_orientations_are_rotations_from_the_first_one() -> None:
    phone = sensor()
    turn = 0.02
    phone.offer(0.0, orientation=(0.0, 0.0, math.sin(0.5), math.cos(0.5)))
    for k in range(1, 4):
        half = 0.5 + 0.5 * turn
        phone.offer(0.01 * k, orientation=(0.0, 0.0, -math.sin(half), -math.cos(half)))
    found = phone.ring.read(0.02, 1e-3)
    assert found is not None
    np.testing.assert_allclose(found[6:], [0.0, 0.0, turn], atol=1e-12)


RATE = (0.01, 0.0, 0.02)


def swaying(k: int) -> dict[str, tuple[float, float, float]]:
    """Return the sample of a sensor on a tree, one of 100 a second."""
    phase = 0.01 * k
    turned = (0.02 * math.sin(phase), 0.01, 0.0)
    return {'acceleration': (0.5 * math.sin(phase), 0.1, 9.81), 'rate': turned}


@pytest.mark.parametrize(
    'first',
    [
        {'acceleration': UP},
        {'rate': RATE},
        {'acceleration': (math.nan, 0.0, 0.0), 'rate': RATE},
        {'acceleration': UP, 'rate': RATE, 'orientation': (0.0, 0.0, 0.0, 1.0)},
    ],
)
def test_a_majority_decides_what_a_sensor_measures(first: dict[str, Any]) -> None:
    phone = sensor()
    phone.offer(0.0, **first)
    refused = sum(not phone.offer(0.01 * k, **swaying(k)) for k in range(1, 1141))
    assert phone.quantities == ('acceleration', 'rate')
    assert refused <= 1
    found = phone.ring.read(11.0, 0.01)
    assert found is not None
    assert np.isfinite(found[:6]).all()


def test_a_part_that_stops_does_not_make_the_rest_useless() -> None:
    phone = sensor()
    for k in range(500):
        assert phone.offer(0.01 * k, **swaying(k))
    refused = 0
    for k in range(500, 1000):
        refused += not phone.offer(0.01 * k, acceleration=swaying(k)['acceleration'])
        if k == 550:
            assert 'a quantity is missing' in phone.trouble
    assert phone.quantities == ('acceleration',)
    assert phone.lost == ('rate',)
    assert refused <= 101
    assert not phone.trouble


@pytest.mark.parametrize('broken', ['acceleration', 'rate'])
def test_a_quantity_without_an_axis_from_the_beginning_is_named(broken: str) -> None:
    phone = sensor()
    for k in range(10):
        moved = swaying(k)
        assert phone.offer(0.01 * k, **moved | {broken: (math.nan, *moved[broken][1:])})
    assert phone.unusable == (broken,)
    for k in range(10, 30):
        phone.offer(0.01 * k, **swaying(k))
    assert phone.unusable == ()
    assert phone.lost == ()


def test_a_dead_sensor_is_told_within_two_seconds() -> None:
    phone = sensor()
    for k in range(500):
        phone.offer(0.01 * k, **swaying(k))
    taken = sum(phone.offer(0.01 * k, **swaying(500)) for k in range(500, 800))
    assert taken <= 101
    assert phone.counts.stuck >= 199
    assert 'repeats the same numbers' in phone.trouble
    assert phone.offer(8.0, **swaying(801))
    assert not phone.trouble


def test_spikes_are_left_out_and_counted() -> None:
    rng = np.random.default_rng(3)
    phone = sensor()
    n_spikes = 0
    for k in range(5000):
        sample = {key: np.array(each) for key, each in swaying(k).items()}
        sample['acceleration'] += rng.normal(size=3) * 0.05
        is_spike = k > 30 and rng.random() < 0.01
        if is_spike:
            sample['acceleration'] += 78.0 * rng.choice([-1.0, 1.0], 3)
        n_spikes += is_spike
        assert phone.offer(0.01 * k, **sample) != is_spike
    assert phone.counts.spikes == phone.counts.refused == n_spikes > 30


def test_a_knock_of_some_length_is_no_spike() -> None:
    phone = sensor()
    for k in range(500):
        phone.offer(0.01 * k, **swaying(k))
    knocked = [(80.0 + 0.1 * k, 0.0, 0.0) for k in range(9)]
    taken = [
        phone.offer(5.0 + 0.01 * k, acceleration=each, rate=RATE) for k, each in enumerate(knocked)
    ]
    assert taken == [False] * 3 + [True] * 6


def streamed(ahead: float, delays: list[float], seconds: float = 5.0) -> MotionSensor:
    """Return a sensor of 50 Hz whose clock is ahead [s], each sample under way for a delay."""
    phone = sensor()
    for k in range(round(50.0 * seconds)):
        time = 100.0 + 0.02 * k
        way = delays[k % len(delays)]
        phone.offer(time + ahead, acceleration=(0.01 * k, 0.0, 9.81), arrival=time + way)
    return phone


@pytest.mark.parametrize('ahead', [0.2, 0.5, 1.0, 60.0])
def test_a_clock_that_is_ahead_is_told_and_its_samples_refused(ahead: float) -> None:
    phone = streamed(ahead, [0.0, 0.02, 0.05])
    assert phone.counts.ahead > 25
    assert float(phone.trouble.split()[3]) == pytest.approx(ahead, abs=0.11)
    assert phone.trouble.endswith('s from the steps: check its clock')
    assert not phone.is_behind


@pytest.mark.parametrize('delays', [[0.0, 0.02], [0.0] * 40 + [1.0] * 5, [0.3, 0.02], [-0.05]])
def test_a_right_clock_is_not_told_to_be_wrong(delays: list[float]) -> None:
    phone = streamed(0.0, delays)
    assert phone.counts.ahead == 0
    assert not phone.is_behind


def test_a_clock_that_is_set_right_is_followed_again() -> None:
    phone = streamed(1.0, [0.02])
    for k in range(300):
        time = 106.0 + 0.02 * k
        is_kept = phone.offer(time, acceleration=(0.01 * k, 0.0, 9.81), arrival=time + 0.02)
    assert is_kept


def test_a_clock_that_may_be_behind_is_told() -> None:
    phone = streamed(-0.5, [0.02, 0.05])
    assert phone.is_behind
    assert phone.lateness == pytest.approx(0.52)
    assert phone.counts.refused == 0
