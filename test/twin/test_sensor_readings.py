# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What the native core reads of sensors: by the model, beyond it, late, silent or refused."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
import resource
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tree_sway.core.arrays import Floats
from tree_sway.twin.alignment import Alignment, GRAVITY
from tree_sway.twin.late_wind import LateWind
from tree_sway.twin.motion_sensor import MotionSensor
from tree_sway.twin.sensor_place import PlaceMotion, SensorPlace
from tree_sway.twin.sensor_readings import SensorReadings
from tree_sway.twin.sensor_spectrum import SensorSpectrum
from tree_sway.twin.sensor_track import as_felt, FoundMounting, sensed_rows, SensorTrack

M, N, DT = 7, 4, 1.0 / 60.0
REST = (0.0, 0.0, GRAVITY)


def readings(count: int, seed: int = 0) -> tuple[SensorReadings, list[PlaceMotion], Floats]:
    """Return readings of sensors on a drawn model, their places and its state (3, m)."""
    rng = np.random.default_rng(seed)
    law: Any = SimpleNamespace(
        all_stiffness=rng.uniform(9.0, 90.0, M), all_damping=rng.random(M), count=N,
        air_damping=rng.random(N), mean_speed=7.0, dt=DT,
    )  # fmt: skip
    places = [PlaceMotion(*rng.normal(size=(2, 3, M))) for _ in range(count)]
    sensors = [MotionSensor(f's{k}', SensorPlace(0, 0.5)) for k in range(count)]
    for each in sensors:
        each._sample[:] = 0.0
    tracks = [SensorTrack(each, 1.0, DT) for each in sensors]
    for track, place in zip(tracks, places, strict=True):
        track.motion = place
    state = rng.normal(size=(3, M))
    return SensorReadings(law, tracks, state, LateWind()), places, state


def track_of(of: SensorReadings) -> SensorTrack:
    return of._tracks[0]


@pytest.mark.parametrize('count', [0, 1, 3])
def test_measurements_are_rows_by_the_state(count: int) -> None:
    of, places, state = readings(count)
    assert of.read(0.0, 5, 4) == 5
    law = of._unknown
    for k, place in enumerate(places):
        rows = sensed_rows(place, law.all_stiffness, law.all_damping)
        np.testing.assert_allclose(of._sensed[5, k], rows @ state.ravel(), atol=1e-12)
    np.testing.assert_allclose(of._forces[5], law.air_damping * state[1, :N] + state[2, :N])
    assert not of._sensed[[4, 6]].any()
    assert not of.is_known.any()


@pytest.mark.parametrize('has_gravity', [True, False])
def test_what_is_beyond_the_model_is_turned_into_the_frame_of_the_tree(has_gravity: bool) -> None:
    of, (place,), state = readings(1)
    track, rng = track_of(of), np.random.default_rng(1)
    turn = Rotation.random(random_state=3).as_matrix()
    scale, noise = np.array([GRAVITY, 0.02]), np.full(3, 0.1)
    found = Alignment(turn, scale, has_gravity, 0.9, noise)
    track.sensor.quantities = ('acceleration', 'rate')
    track.heed()
    track.take(FoundMounting(found, rng.normal(size=9)))
    sample = rng.normal(size=9)
    track.sensor._sample[:] = sample
    track.sensor.ring.ask_for((True, True, True))
    assert track.sensor.ring.keep(0.3) == 'accepted'
    spectrum = SensorSpectrum(1.0, DT, N)
    track.native.series = spectrum.native.at
    of.read(0.3, 0, -1)
    assert of.is_known.all()
    law = of._unknown
    rows = as_felt(sensed_rows(place, law.all_stiffness, law.all_damping), has_gravity=has_gravity)
    expected = found.motion(sample) - track.bias - rows @ state.ravel()
    np.testing.assert_allclose(of.beyond[0], expected, atol=1e-12)
    moved = found.motion(sample)
    series = np.concatenate((moved[3:5], of._forces[0], moved[:2]))
    np.testing.assert_allclose(spectrum._series[0, 0], series, atol=1e-12)
    assert spectrum.advance()
    np.testing.assert_array_equal(track._sensed[0], sample)
    np.testing.assert_array_equal(track._computed[0], of._sensed[0, 0])
    assert track.native.count == 1


def test_a_sensor_is_silent_after_a_second_and_counted_once() -> None:
    of, *_ = readings(1)
    track = track_of(of)
    track.sensor.offer(0.0, acceleration=REST)
    track.heed()
    track.native.is_mounted = track.native.in_use = 1
    for step in range(180):
        of.read(step * DT, step, step - 1)
        if step * DT < 0.9:
            assert track.in_use
        assert 'clock' not in track.problem
    track.heed()
    assert track.is_silent
    assert not track.in_use
    assert track.sensor.counts.silent == 1
    assert 'silent for 3 s' in track.problem


@pytest.mark.parametrize(('seen', 'left'), [(0.0, 20), (12.5, 8), (19.8, 1), (20.0, 1), (21.0, 1)])
def test_a_mounting_is_promised_in_a_second_or_more(seen: float, left: int) -> None:
    track = track_of(readings(1)[0])
    track.sensor.offer(0.0, acceleration=REST)
    track.native.count = round(seen / DT)
    assert f'found within {left} s of sway' in track.problem


def test_the_mean_difference_from_the_model_is_that_of_the_last_ten_minutes() -> None:
    track, rng = track_of(readings(1)[0]), np.random.default_rng(2)
    turn = Rotation.random(random_state=3).as_matrix()
    found = Alignment(turn, np.array([1.0, 1.0]), True, 0.9, np.full(3, 0.1))
    track.sensor.quantities = ('acceleration', 'rate')
    track.heed()
    track.take(FoundMounting(found, np.zeros(9)))
    sample = rng.normal(size=9)
    track._sensed[:], track._computed[:] = sample, 0.0
    for minutes, left in ((10, np.exp(-1.0)), (30, np.exp(-4.0))):
        for _ in range(minutes * 60):
            track.native.count += 60
            track.heed()
        missed = found.motion(sample) - track.bias
        np.testing.assert_allclose(missed, left * found.motion(sample), rtol=0.15)


def test_the_noise_is_that_of_the_newest_samples_but_for_sway_between_fewer() -> None:
    """That of a battery that faded, found in wind, was told for an hour of a calm."""
    track, rng = track_of(readings(1)[0]), np.random.default_rng(2)
    track.sensor.quantities = ('acceleration', 'rate')
    track.heed()
    known = Alignment(np.eye(3), np.array([GRAVITY, 1.0]), True, 0.9, np.full(3, 0.1))
    track.take(FoundMounting(known, np.zeros(9)))
    assert track.fitted_noise == 0.1
    time = 0.0
    for period, noise, told in (
        (DT, 0.02, 0.02), (DT, 0.05, 0.05), (0.1, 0.2, 0.05), (0.1, 0.01, 0.01), (DT, 0.02, 0.02),
    ):  # fmt: skip
        for _ in range(1200):
            time += period
            moved = noise * rng.normal(size=(2, 3))
            felt = np.divide(REST, GRAVITY) + moved[0]
            track.sensor.offer(time, acceleration=felt, rate=moved[1])
        track.native.count += 1800
        track.heed()
        held = (period / DT) ** 0.5
        assert track.fitted_noise == pytest.approx(held * told, rel=0.1)
        assert track.watched_noise == pytest.approx(held * told * GRAVITY, rel=0.1)
    slow = replace(known, noise=np.full(3, 0.3), azimuth_error=-1.0)
    track.take(FoundMounting(slow, np.zeros(9)))
    assert track.fitted_noise == pytest.approx(0.3)


@pytest.mark.parametrize(
    ('unit', 'error', 'is_taken'),
    [(1.0, 0.1, True), (1.0, 0.14, True), (1.0, 0.2, False), (0.0175, 0.14, False),
     (0.0175, 0.05, True)],
)  # fmt: skip
def test_a_mounting_that_is_less_sure_does_not_replace_one(
    unit: float, error: float, is_taken: bool
) -> None:
    track = track_of(readings(1)[0])
    track.sensor.quantities = ('acceleration', 'rate')
    track.heed()
    known = Alignment(np.eye(3), np.ones(2), True, 0.9, np.full(3, 0.1), azimuth_error=0.1)
    track.take(FoundMounting(known, np.zeros(9)))
    other = replace(known, scale=np.array([1.0, unit]), azimuth_error=error)
    track.take(FoundMounting(other, np.zeros(9)))
    assert track.alignment is (other if is_taken else known)
    track.native.is_refused = 1
    track.take(FoundMounting(other, np.zeros(9)))
    assert track.alignment is other


@pytest.mark.parametrize(
    ('angle', 'minutes', 'is_taken'), [(0.9, 5, True), (0.5, 5, False), (0.9, 11, False)]
)
def test_a_mounting_that_all_motion_and_more_contradicts_is_replaced(
    angle: float, minutes: int, is_taken: bool
) -> None:
    """One of ten minutes after it was forgotten is not of more motion than it."""
    track = track_of(readings(1)[0])
    track.sensor.quantities = ('acceleration', 'rate')
    track.heed()
    known = Alignment(np.eye(3), np.ones(2), True, 0.9, np.full(3, 0.1), azimuth_error=0.1)
    track.take(FoundMounting(known, np.zeros(9)))
    track.native.count = round(minutes * 60.0 / DT)
    other = replace(known.turned(angle), azimuth_error=0.2)
    track.take(FoundMounting(other, np.zeros(9)))
    assert track.alignment is (other if is_taken else known)


def test_a_sensor_that_disagrees_is_refused_until_it_agrees() -> None:
    of, *_ = readings(1)
    track = track_of(of)
    track.native.is_mounted = track.native.in_use = 1

    def judged(size: float, seconds: float) -> float:
        """Return the time until use begins or ends [s]."""
        was = track.in_use
        for step in range(round(seconds / DT)):
            track.judge(size)
            if track.in_use != was:
                return step * DT
        return seconds

    assert judged(9.0, 1.0) == 1.0
    track.native.excess = track.native.usual = 1.0
    # A running mean over 2 s goes from 1 to 16 of 30, and what is usual has grown by then.
    assert 2.0 * np.log(29.0 / 14.0) < judged(30.0, 60.0) < 2.0
    track.heed()
    assert track.sensor.counts.disagreed == 1
    assert track.native.count == -300
    # From 16 to 4 of 1, and 5 s more.
    assert judged(1.0, 60.0) == pytest.approx(2.0 * np.log(15.0 / 3.0) + 5.0, abs=0.1)


def test_what_is_usual_of_a_sensor_is_no_disagreement() -> None:
    of, *_ = readings(1)
    track = track_of(of)
    track.native.is_mounted = track.native.in_use = 1
    for size in (*np.linspace(1.0, 10.0, 7200), *[50.0] * 3600):
        track.judge(size)
    assert track.in_use
    for _ in range(600):
        track.judge(1e6)
    assert not track.in_use


def test_a_limb_of_more_modes_than_the_filter_is_no_disagreement_and_a_later_fault_is() -> None:
    of, *_ = readings(1)
    track, rng = track_of(of), np.random.default_rng(5)
    track.native.is_mounted = track.native.in_use = 1
    for size in 20.0 * rng.gamma(2.0, size=3600):
        track.judge(size)
    assert track.in_use
    for _ in range(180):
        track.judge(1e6)
    assert not track.in_use


def test_gusty_sway_of_a_twig_that_no_model_has_is_no_disagreement() -> None:
    of, *_ = readings(1)
    track = track_of(of)
    track.native.is_mounted = track.native.in_use = 1
    for step in range(7200):
        track.judge(70.0 + 65.0 * np.sin(2.0 * np.pi * step * DT / 12.0))
    assert track.excess < 120.0
    assert track.in_use
    for _ in range(180):
        track.judge(1e6)
    assert not track.in_use


def test_a_twig_whose_sensor_falls_is_left_at_once_and_not_for_its_own_swings() -> None:
    of, *_ = readings(1)
    track = track_of(of)
    track.native.is_mounted = track.native.in_use = 1
    for step in range(7200):
        track.judge(1200.0 if step % 600 == 0 else 16.0)
    assert track.in_use
    for _ in range(9):
        track.judge(5000.0)
    assert not track.in_use


def test_nothing_is_compared_with_a_model_whose_anemometer_is_silent() -> None:
    of, *_ = readings(1)
    track, wind = track_of(of), of._wind

    def run(first: float, seconds: float) -> int:
        """Read some seconds, and return how many samples were remembered."""
        before = track.native.count
        for step in range(round(first / DT), round((first + seconds) / DT)):
            time = step * DT
            wind.push(5.0, 0.0, 0.0, DT)
            acceleration = (0.1 * (step % 2), 0.0, GRAVITY)
            track.sensor.offer(time, acceleration=acceleration)
            of.read(time, step, -1)
        return int(track.native.count) - before

    assert run(0.0, 5.0) == 300
    wind.is_silent = True
    assert run(5.0, 5.0) == 300, 'nobody knows yet how often it sends'
    wind.is_silent = False
    assert run(10.0, 30.0) == 1800
    found = track.alignment
    wind.is_silent = True
    assert run(40.0, 20.0) == 0
    assert track.alignment is found
    assert not track.is_silent
    wind.is_silent = False
    assert 890 < run(60.0, 45.0) < 910
    assert track.alignment is not found


def test_steps_before_a_knock_are_none_of_its_whole_motion() -> None:
    of, *_ = readings(1)
    track = track_of(of)
    track.native.count = -300
    track.note_step(1800)
    track.native.count = 1200
    track.note_step(3300)
    assert track.whole == 1200


def test_one_spike_in_a_hundred_samples_is_no_disagreement() -> None:
    of, *_ = readings(1)
    track = track_of(of)
    track.native.is_mounted = track.native.in_use = 1
    for step in range(36000):
        track.judge(1.0 if step % 100 else 1e6)
    assert track.in_use


def lateness_of(arrivals: list[tuple[float, float]], seconds: float) -> int:
    """Return the steps by which a sensor is read late; arrivals are (when, stamp), both in [s]."""
    of, *_ = readings(1)
    sensor, k = track_of(of).sensor, 0
    for step in range(round(seconds / DT)):
        time = step * DT
        while k < len(arrivals) and arrivals[k][0] <= time:
            sensor.offer(arrivals[k][1], acceleration=(0.1 * (k % 2), 0.0, GRAVITY))
            k += 1
        of.read(time, step, -1)
    return int(of.native.late)


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


@pytest.mark.parametrize('rate', [10.0, 25.0, 60.0, 150.0])
def test_the_noise_that_is_told_is_the_one_in_the_spectrum_of_sway(rate: float) -> None:
    """By the steps between few samples, which are on lines, there is hardly any."""
    of, _, state = readings(1)
    state[:] = 0.0
    track, rng, deviation = track_of(of), np.random.default_rng(4), 0.02
    track._next_fit = 10**9
    track.sensor.quantities = ('acceleration', 'rate')
    track.heed()
    known = Alignment(np.eye(3), np.ones(2), True, 0.9, np.full(3, 0.1))
    track.take(FoundMounting(known, np.zeros(9)))
    spectrum = SensorSpectrum(1.0, DT, N)
    track.native.series = spectrum.native.at
    stamp = 0.4 * DT
    for step in range(9000):
        while stamp < (step + 1) * DT + 1.0 / rate:
            noise = deviation * rng.normal(size=(2, 3))
            track.sensor.offer(stamp, acceleration=REST + noise[0], rate=noise[1])
            stamp += 1.0 / rate
        of.read(step * DT, step, step - 1)
        spectrum.advance()
    track._computed[:, 6:9] = track._sensed[:, 3:6]  # a model that turns as fast as it
    found = track.search()()
    assert found.alignment.noise[1] == pytest.approx(deviation, rel=0.08)
    sure = replace(found.alignment, problem='', azimuth_error=0.0)
    track.take(found._replace(alignment=sure))
    is_slow = spectrum.circular < 2.0 * np.pi
    power = spectrum.products[is_slow][:, (0, 1), (0, 1)].real.mean()
    assert spectrum.power_of_noise(track.fitted_noise) == pytest.approx(power, rel=0.15)


def test_a_mounting_of_quantities_that_a_sensor_no_more_measures_is_not_taken() -> None:
    of, _, _ = readings(1)
    track: Any = track_of(of)
    track.sensor.quantities = ('acceleration', 'rate')
    of.read(0.0, 0, -1)
    found = Alignment(np.eye(3), np.ones(2), True, 0.9, np.full(3, 0.1))
    track.search = lambda _: lambda: FoundMounting(found, np.zeros(9))
    track._next_fit = 0
    of.read(DT, 1, 0)
    track.sensor.quantities = ('acceleration', 'rate', 'orientation')
    for step in range(2, 40):
        of.read(step * DT, step, step - 1)
        track._next_fit = 10**9
    assert track.alignment is None
    assert not track.in_use


def backed(array: Floats) -> float:
    """
    Share of an array's pages that have memory or are swapped out, by the kernel's map of them.

    What the whole process holds also falls when it frees what earlier tests have left.
    """
    page = resource.getpagesize()
    first = -(-array.ctypes.data // page)
    count = (array.ctypes.data + array.nbytes) // page - first
    with Path('/proc/self/pagemap').open('rb', buffering=0) as pages:
        pages.seek(8 * first)
        entries = np.frombuffer(pages.read(8 * count), np.uint64)
    assert len(entries) == count
    return float(np.mean(entries >> np.uint64(62) > 0))


def test_the_memory_of_a_sensor_is_there_from_the_beginning() -> None:
    """It was asked for alone, and came as samples did: a process grew for ten minutes."""
    track = SensorTrack(MotionSensor('a', SensorPlace(0, 0.5)), 1.0, 1e-3)
    assert track._sensed.nbytes + track._computed.nbytes > 5e7
    assert backed(track._sensed) == 1.0
    assert backed(track._computed) == 1.0
