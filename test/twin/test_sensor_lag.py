# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A sensor that is late is told by its lean in slow gusts, and a right one never."""

from __future__ import annotations

import numpy as np
import pytest

from tree_sway.core.arrays import Complexes, Floats
from tree_sway.twin import sensor_track
from tree_sway.twin.alignment import Alignment, GRAVITY
from tree_sway.twin.motion_sensor import MotionSensor
from tree_sway.twin.sensor_lag import sensor_lag, SensorLag
from tree_sway.twin.sensor_place import SensorPlace
from tree_sway.twin.sensor_track import NO_LAG, OtherSensor, SensorTrack

DT, F1, LOSS = 1.0 / 20.0, 1.2, 10.0


def noise(
    seconds: float, rng: np.random.Generator, loss: float = LOSS, across: float = 1.0
) -> tuple[Floats, Floats]:
    """
    Draw slow gusts to east and north, and gusts that share ``exp(-loss f)`` of them, (n, 2).

    ``across`` is the size of those to the north, across the wind.
    """
    n = round(seconds / DT)
    frequency = np.fft.rfftfreq(n, DT)[:, None]
    lines = rng.normal(size=(2, len(frequency), 2, 2)) @ [1.0, 1j] * [1.0, across]
    lines /= (1.0 + 6.0 * frequency * 8.0) ** (5.0 / 6.0)
    shared = np.exp(-loss * frequency)
    other = shared * lines[0] + np.sqrt(1.0 - shared**2) * lines[1]
    slow = lines[0] * np.exp(-LOSS * frequency)
    first, second = (np.fft.irfft(each, n, axis=0) for each in (slow, other))
    return first / first.std(), second / second.std()


def lag_of(late: float, seconds: float, seed: int = 1, loss: float = LOSS) -> SensorLag:
    model, sensed = noise(seconds + 10.0, np.random.default_rng(seed), loss)
    shift = round(late / DT)
    return sensor_lag(sensed[100 - shift : -100 - shift], model[100:-100], F1, DT)


@pytest.mark.parametrize('late', [-2.0, -1.5, 1.5, 2.0])
def test_a_late_or_early_sensor_is_told_with_its_lag(late: float) -> None:
    found = lag_of(late, 600.0)
    assert found.is_sure
    assert found.seconds == pytest.approx(late, abs=3.0 * found.error)
    assert found.error < 0.4
    assert ('after' if late > 0.0 else 'before') in str(found)


@pytest.mark.parametrize(('error', 'is_sure'), [(0.7, False), (0.4, True)])
def test_a_lag_of_two_deviations_is_none(error: float, is_sure: bool) -> None:
    found = SensorLag(-1.5, error, evidence=30.0, over_none=7.0, n_lines=60)
    assert found.is_sure == is_sure


def test_the_delay_of_the_expected_wind_is_not_that_of_the_sensor() -> None:
    def later(hertz: Floats) -> Complexes:
        return np.exp(-2j * np.pi * (1.0 - 2.0 * hertz) * hertz)

    sensed, _ = noise(600.0, np.random.default_rng(2))
    hertz = np.fft.rfftfreq(len(sensed), DT)
    lines = np.fft.rfft(sensed, axis=0) * later(hertz).conj()[:, None]
    model = np.fft.irfft(lines, len(sensed), axis=0)
    found = sensor_lag(sensed, model, F1, DT, later=later)
    assert found.seconds == pytest.approx(0.0, abs=0.1)
    assert sensor_lag(sensed, model, F1, DT).over_none > 10.0
    assert sensor_lag(sensed, model, F1, DT, later=later, about=0.6).seconds < -0.5


def test_a_right_sensor_is_not_told_to_be_late() -> None:
    found = [lag_of(0.0, seconds, seed) for seconds in (100.0, 300.0) for seed in range(100)]
    assert not any(each.is_sure or each.is_by_chance for each in found)
    within = [abs(each.seconds) < 2.0 * each.error for each in found]
    assert np.mean(within) > 0.85


def in_gusts(late: float, seconds: float, loss: float, shared: float, seed: int) -> SensorLag:
    """Find the lag in gusts along the wind, of which the law says how many are shared."""

    def later(hertz: Floats) -> Complexes:
        return np.exp(-shared * hertz).astype(np.complex128)

    model, sensed = noise(seconds + 10.0, np.random.default_rng(seed), loss, 0.25)
    shift = round(late / DT)
    moved = sensed[100 - shift : -100 - shift]
    return sensor_lag(moved, model[100:-100], F1, DT, later=later)


def test_a_lag_is_told_as_surely_as_the_shared_gusts_tell_it() -> None:
    """A mast 12 m aside of the wind of 7 m/s shares ``exp(-17 f)``, one upwind ``exp(-5 f)``."""
    aside = [in_gusts(0.0, 160.0, 17.0, 17.0, seed) for seed in range(400)]
    assert np.mean([each.is_sure for each in aside]) < 0.02
    error = np.std([each.seconds for each in aside])
    assert np.median([each.error for each in aside]) == pytest.approx(error, rel=0.4)
    upwind = [in_gusts(late, 160.0, 5.0, 5.0, seed) for late in (-1.5, 1.5) for seed in range(50)]
    assert np.mean([each.is_sure for each in upwind]) > 0.8
    known = [in_gusts(2.0, 600.0, 17.0, 17.0, seed) for seed in range(50)]
    assert np.mean([each.is_sure for each in known]) > 0.5


def test_little_in_common_is_not_nothing_where_the_law_expects_no_more() -> None:
    aside = [in_gusts(0.0, 200.0, 25.0, 25.0, seed) for seed in range(100)]
    assert not any(each.is_by_chance for each in aside)
    alien = [in_gusts(0.0, 600.0, 1e9, 17.0, seed) for seed in range(50)]
    assert np.mean([each.is_by_chance for each in alien]) > 0.7


def test_motions_of_nothing_in_common_are_told() -> None:
    found = [lag_of(0.0, 200.0, seed, loss=1e9) for seed in range(100)]
    assert np.mean([each.is_sure for each in found]) < 0.02
    assert np.mean([each.is_by_chance for each in found]) > 0.95
    assert not any(lag_of(0.0, 200.0, seed).is_by_chance for seed in range(100))


def test_a_short_motion_tells_nothing() -> None:
    assert not lag_of(2.0, 20.0).is_sure
    assert lag_of(2.0, 20.0).error == np.inf


def seeing(sensed: Floats, model: Floats) -> SensorTrack:
    """Return a sensor in use that has seen a lean, (n, 2), beside that of the model."""
    track = SensorTrack(MotionSensor('phone', SensorPlace(0, 0.5)), F1, DT)
    track._quantities = ('acceleration',)
    n = track.native.count = len(model)
    track._sensed[:n] = np.nan
    track._sensed[:n, :3] = [0.0, 0.0, GRAVITY]
    track._sensed[:n, :2] += sensed
    track._computed[:n, 3:5] = model
    track.native.is_mounted = track.native.in_use = 1
    return track


def said(track: SensorTrack, *, is_told: bool) -> tuple[str, ...]:
    """Return what a sensor says after its mounting was found again."""
    track.take(track.search(NO_LAG._replace(is_told=is_told))())
    assert track.alignment is not None
    return (*track.alignment.notes, *filter(None, [track.alignment.problem]))


@pytest.mark.parametrize('is_told', [True, False])
def test_a_late_sensor_is_left_where_the_way_of_the_wind_is_known(is_told: bool) -> None:
    model, sensed = noise(600.0, np.random.default_rng(3))
    track = seeing(sensed, model)
    assert said(track, is_told=is_told) == ()
    assert track.in_use
    track = seeing(sensed[:-40], model[40:])
    (told,) = said(track, is_told=is_told)
    assert told.startswith('its motion comes')
    assert track.in_use != is_told


def test_a_lag_that_is_no_chance_is_told_before_three_minutes() -> None:
    def is_left(late: float, seed: int) -> bool:
        model, sensed = noise(150.0, np.random.default_rng(seed), 4.0)
        track = seeing(np.roll(sensed, round(late / DT), axis=0), model)
        track.take(track.search(NO_LAG._replace(is_told=True))())
        return not track.in_use

    assert sum(is_left(2.0, seed) for seed in range(20)) > 10
    assert not any(is_left(0.0, seed) for seed in range(20))


@pytest.mark.parametrize(
    ('changes', 'is_clear'),
    [
        ({}, True),
        ({'over_none': 9.0}, False),
        ({'evidence': 19.0}, False),
        ({'seconds': 1.2}, False),
        ({'can_differ': 0.9}, False),
    ],
)
def test_a_lag_is_clear_where_nothing_speaks_against_it(
    changes: dict[str, float], is_clear: bool
) -> None:
    """The values are those of a sensor 2 s late, a minute after it was switched on."""
    found = SensorLag(2.2, 1.0, evidence=25.6, over_none=13.8, n_lines=32, can_differ=1.9)
    assert found._replace(**changes).is_clear == is_clear


@pytest.mark.parametrize('is_whole', [True, False])
def test_a_clear_lag_is_told_at_once_where_no_wind_is_missing(
    is_whole: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    found = SensorLag(2.2, 1.0, evidence=25.6, over_none=13.8, n_lines=32, can_differ=1.9)
    monkeypatch.setattr(sensor_track, 'sensor_lag', lambda *_, **__: found)
    track = seeing(*noise(80.0, np.random.default_rng(12), 4.0))
    track.take(track.search(NO_LAG._replace(is_told=True, is_whole=is_whole))())
    assert track.in_use != is_whole


@pytest.mark.parametrize(('over_none', 'after'), [(2.0, 16.0), (4.0, 4.0)])
def test_a_sensor_whose_times_are_in_doubt_is_looked_at_again_soon(
    over_none: float, after: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    found = SensorLag(1.0, 1.0, evidence=15.0, over_none=over_none, motion=80.0, n_lines=46)
    monkeypatch.setattr(sensor_track, 'sensor_lag', lambda *_, **__: found)
    track = seeing(*noise(80.0, np.random.default_rng(12), 4.0))
    assert said(track, is_told=True) == ()
    assert (track._next_fit - track.native.count) * DT == pytest.approx(after, abs=0.1)


def test_a_sensor_is_left_when_its_motion_has_nothing_of_the_wind() -> None:
    model, sensed = noise(300.0, np.random.default_rng(4), 1e9)
    track = seeing(sensed, model)
    assert said(track, is_told=True)
    assert not track.in_use


def test_a_mirrored_lean_is_that_of_an_acceleration_of_the_opposite_sign() -> None:
    model, sensed = noise(300.0, np.random.default_rng(5))
    track = seeing(sensed, model)
    assert said(track, is_told=True) == ()
    track = seeing(sensed, model)
    track._sensed[:, :3] *= -1.0
    assert said(track, is_told=True) == ('acceleration of the opposite sign',)
    assert track.in_use


def test_a_late_sensor_stays_late_until_that_is_unlikely() -> None:
    model, sensed = noise(200.0, np.random.default_rng(3))
    track = seeing(sensed[:-25], model[25:])
    assert said(track, is_told=True) == ()
    track._left_for = -1.25
    assert said(track, is_told=True)
    assert not track.in_use
    assert said(seeing(sensed, model), is_told=True) == ()


def test_a_sensor_that_was_left_returns_by_evidence_for_its_own_times_alone() -> None:
    """Evidence of a lag that falls, as in gusts that tell little, is none for its own times."""

    def found(late: float, seed: int, seconds: float) -> tuple[bool, str]:
        model, sensed = noise(seconds, np.random.default_rng(seed))
        track = seeing(np.roll(sensed, round(late / DT), axis=0), model)
        track._left_for = -1.0
        (told,) = said(track, is_told=True)
        return track.in_use, told

    early = [found(-1.0, seed, 150.0) for seed in range(40)]
    assert sum(is_back for is_back, _ in early) <= 2
    right = [found(0.0, seed, 500.0) for seed in range(20)]
    assert sum(is_back for is_back, _ in right) > 10
    assert all(('followed again' in told) == is_back for is_back, told in early + right)


def said_beside(late: float, others: dict[str, float], own: float = 0.0) -> str:
    """Return what a late sensor says beside others, by the lag at which each moves [s]."""
    model, sensed = noise(200.0, np.random.default_rng(3))
    limb = np.full((len(sensed), 9), np.nan)
    limb[:, :3] = 0.0, 0.0, GRAVITY
    limb[:, :2] += sensed + 0.2 * noise(200.0, np.random.default_rng(4))[1]
    upright = Alignment(np.eye(3), np.ones(2), True, 1.0, np.zeros(3))
    track = seeing(np.roll(sensed, round(late / DT), axis=0), model)
    beside = tuple(
        OtherSensor(name, upright, np.roll(limb, round(lag / DT), axis=0), 0.0, abs(lag) + own)
        for name, lag in others.items()
    )
    track.take(track.search(NO_LAG._replace(is_told=True, others=beside))())
    assert track.alignment is not None
    assert track.in_use == (not track.alignment.problem)
    return track.alignment.problem


@pytest.mark.parametrize('late', [-1.0, -0.5, 0.5, 1.0])
def test_a_sensor_whose_times_are_not_those_of_most_is_left(late: float) -> None:
    told = said_beside(late, {'a': 0.0, 'b': 0.0, 'c': 0.0})
    side = 'after' if late > 0.0 else 'before'
    assert told.startswith(f'its motion comes {abs(late):.1f} s')
    assert told.endswith(f'{side} that of a: check its clock')


def test_sensors_of_one_time_are_followed() -> None:
    assert not said_beside(0.0, {'a': 0.0, 'b': 0.0})
    assert not said_beside(0.0, {'a': 0.0, 'b': 1.0, 'c': 0.0})
    assert not said_beside(0.0, {})


def test_of_two_sensors_both_are_left_unless_one_is_nearer_to_the_model() -> None:
    assert said_beside(0.0, {'a': 1.0}, own=-1.0)
    assert not said_beside(0.0, {'a': 1.0})


def test_steps_are_compared_of_which_no_sensor_has_missed_one() -> None:
    model, sensed = noise(60.0, np.random.default_rng(6))
    track = seeing(sensed, model)
    count = track.native.count
    track.note_step(count + 100)
    assert track.whole == 0
    track.native.count = count + 300
    track.note_step(count + 400)
    assert track.whole == 300
    track.note_step(count + 402)  # two were missed
    assert track.whole == 0
