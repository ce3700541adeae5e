# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Gusts that travel: every place gets the anemometer's wind, later by distance over speed."""

from __future__ import annotations

import threading
import tracemalloc

from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
import pytest

from tree_sway.core.wind.gusts.gust_travel import GustHistory, SLOWEST_GUST
from tree_sway.core.wind.gusts.wind_history import WindHistory
from tree_sway.core.wind.turbulence import Turbulence
from tree_sway.errors import ParameterError

LARGEST_STRETCH = 0.5
"""Largest change of a delay in a second [s]."""

DT = 1.0 / 60.0


def delayed(history, winds, dt=DT):
    """Return the wind at each place, (k, t, 3)."""
    return np.array([history.push(wind, dt).copy() for wind in winds])


def gusts(n, mean=8.0, seed=1):
    return (
        np.array([mean, 0.0, 0.0])
        + Turbulence(mean).record(36_000, 1 / DT, np.random.default_rng(seed))[:n]
    )


def test_a_place_feels_a_gust_when_it_has_travelled_there():
    # The mean is 8 m/s for a minute before a front passes the anemometer: 40 m take 5 s.
    winds = np.tile([8.0, 0.0, 0.0], (4500, 1))
    winds[3600:3630] = [12.0, 0.0, 1.0]
    history = GustHistory(
        [[40.0, 0.0, 0.0], [80.0, 300.0, 9.0]], np.zeros(3), averaging_time=3600.0
    )
    speed = delayed(history, winds)[:, :, 0]
    for column, way in zip(speed.T, (40.0, 80.0), strict=True):
        above = np.flatnonzero(column > 10.0)
        assert (above[0] - 3600) * DT == pytest.approx(way / 8.0, abs=0.05)
        # The gust keeps its length and its run, as the mean wind hardly changes.
        assert (column - 8.0).sum() == pytest.approx(30 * 4.0, rel=0.02)


def test_at_the_anemometer_the_wind_is_felt_as_it_is():
    winds = gusts(300)
    history = GustHistory([[0.0, 0.0, 5.0], [0.0, 0.0, -2.0]])
    assert (delayed(history, winds) == winds[:, None]).all()


def test_gusts_may_travel_faster_than_the_mean_wind():
    winds = np.tile([4.0, 3.0, 0.0], (100, 1))
    places = [[40.0, 30.0, 0.0]]
    delays = []
    for ratio in (1.0, 1.8):
        history = GustHistory(places, np.zeros(3), convection_ratio=ratio)
        delayed(history, winds)
        delays.append(history.delay[0])
    assert delays == pytest.approx([10.0, 10.0 / 1.8])


def test_the_anemometers_place_counts():
    winds = np.tile([0.0, 5.0, 0.0], (10, 1))
    history = GustHistory([[7.0, 20.0, 0.0]], anemometer=[100.0, -5.0, 0.0])
    delayed(history, winds)
    assert history.delay[0] == pytest.approx(5.0)


@pytest.mark.parametrize('heading', [0.0, 1.0, 2.5, -2.0])
def test_without_an_anemometer_the_first_place_feels_the_wind_at_once(heading):
    toward = np.array([np.cos(heading), np.sin(heading), 0.0])
    places = np.array([-20.0, 0.0, 50.0])[:, None] * toward
    history = GustHistory(places)
    delayed(history, np.tile(5.0 * toward, (10, 1)))
    assert history.delay == pytest.approx([0.0, 4.0, 14.0])


def test_upwind_of_the_anemometer_the_wind_is_felt_at_once():
    winds = gusts(200)
    history = GustHistory([[-50.0, 0.0, 0.0], [50.0, 0.0, 0.0]], (0.0, 0.0, 0.0))
    result = delayed(history, winds)
    assert history.delay[0] == 0.0
    assert (result[:, 0] == winds).all()


def test_beyond_its_memory_the_oldest_wind_is_felt():
    history = GustHistory(
        [[100.0, 0.0, 0.0], [1e6, 0.0, 0.0]], np.zeros(3), memory=20.0, capacity=64
    )
    result = delayed(history, gusts(1000))
    assert history.delay[1] <= 20.0
    assert np.isfinite(result).all()
    assert np.abs(result[:, :, 0]).max() < 40.0


@given(
    seed=st.integers(0, 1000),
    turn=st.floats(-180.0, 180.0),
    place=st.tuples(st.floats(-200.0, 200.0), st.floats(-200.0, 200.0)),
)
@settings(max_examples=25, deadline=None)
def test_as_the_wind_turns_time_goes_on_for_every_place(seed, turn, place):
    rng = np.random.default_rng(seed)
    heading = np.radians(np.where(np.arange(1500) < 700, 0.0, turn))
    speed = rng.uniform(0.0, 12.0) * (1.0 + 0.2 * rng.normal(size=1500))
    winds = np.stack([speed * np.cos(heading), speed * np.sin(heading), np.zeros(1500)], axis=1)
    history = GustHistory([[*place, 0.0]], np.zeros(3), averaging_time=5.0)
    delays = []
    for wind in winds:
        history.push(wind, DT)
        delays.append(history.delay[0])
    change = np.abs(np.diff(delays))
    assert change.max() <= LARGEST_STRETCH * DT * (1.0 + 1e-9)
    assert 0.0 <= min(delays)
    assert max(delays) <= 60.0


def test_no_wind_is_lost_or_felt_twice():
    # As delays change the wind is stretched, but a place's run of wind ends where the anemometer's
    # did so before.
    rng = np.random.default_rng(4)
    winds, steps = gusts(2000), rng.uniform(0.2, 3.0, 2000) * DT
    history = GustHistory([[30.0, 0.0, 0.0], [90.0, 10.0, 0.0]], np.zeros(3), averaging_time=10.0)
    run, span = np.zeros((2, 3)), np.zeros(2)
    before = None
    for wind, dt in zip(winds, steps, strict=True):
        result = history.push(wind, dt)
        if before is not None:
            width = dt + before - history.delay
            run, span = run + width[:, None] * result, span + width
        else:
            first = history.delay.copy()
        before = history.delay.copy()
    ends, runs = np.cumsum(steps), np.cumsum(winds * steps[:, None], axis=0)
    for i in range(2):
        begin, end = steps[0] - first[i], steps[0] - first[i] + span[i]
        assert end == pytest.approx(ends[-1] - before[i])
        for k in range(3):
            # Before the start it blew as in the first step.
            expected = (
                np.interp(end, np.r_[0.0, ends], np.r_[0.0, runs[:, k]]) - begin * winds[0, k]
            )
            assert run[i, k] == pytest.approx(expected, rel=1e-9, abs=1e-9)


def test_calm_is_felt_everywhere_and_delays_die_down_with_the_wind():
    history = GustHistory([[30.0, 0.0, 0.0]], np.zeros(3), averaging_time=1.0)
    assert (delayed(history, np.zeros((100, 3))) == 0.0).all()
    delayed(history, np.tile([2.0 * SLOWEST_GUST, 0.0, 0.0], (6000, 1)))
    assert history.delay[0] == pytest.approx(30.0, rel=0.05)
    delayed(history, np.zeros((6000, 3)))
    assert history.delay[0] == pytest.approx(0.0, abs=1e-6)


def test_days_of_wind_cost_no_precision():
    history = GustHistory([[8.0, 0.0, 0.0]], np.zeros(3), capacity=128)
    for wind in np.tile([8.0, 1.0, -1.0], (20_000, 1)):
        result = history.push(wind, 1.0)
    assert result[0] == pytest.approx([8.0, 1.0, -1.0], rel=1e-12)
    assert np.abs(history._history.rows()).max() < 128 * 8.1


@pytest.mark.parametrize('rate', [20, 69, 500, pytest.param(4000, marks=pytest.mark.long)])
def test_the_history_is_a_minute_long_at_any_rate(rate):
    """The gust reaches a tree 50 s downwind in time, at any rate of the steps."""
    dt = 1.0 / rate
    history = GustHistory([[400.0, 0.0, 0.0]], np.zeros(3), averaging_time=3600.0)
    gust = np.array([10.0, 0.0, 0.0])
    mean, speed = np.array([8.0, 0.0, 0.0]), []
    for step in range(58 * rate):
        wind = gust if 1.0 <= step * dt < 2.0 else mean
        felt_now = history.push(wind, dt)[0, 0]
        if step % max(1, rate // 20) == 0:
            speed.append(felt_now)
    time = np.arange(len(speed)) * max(1, rate // 20) * dt
    above = time[np.array(speed) > 9.0]
    # The delay follows the mean wind, which the gust has raised by a little.
    assert above[0] == pytest.approx(1.0 + history.delay[0], abs=0.5)
    assert above[-1] - above[0] == pytest.approx(1.0, abs=0.1)
    assert history.delay[0] == pytest.approx(50.0, abs=0.5)


def test_every_step_of_a_minute_is_kept_as_it_was():
    winds = gusts(4000)
    history = GustHistory([[240.0, 0.0, 0.0]], np.zeros(3), averaging_time=3600.0)
    delayed(history, winds)
    assert history._history.count == 4001


@pytest.mark.usefixtures('memory_alone')
def test_a_step_allocates_nothing():
    history = GustHistory(np.random.default_rng(0).uniform(0.0, 100.0, (20, 3)))
    wind = np.array([7.0, 1.0, 0.0])
    delayed(history, [wind])
    tracemalloc.start()
    for _ in range(50):
        history.push(wind, DT)
    before = tracemalloc.take_snapshot()
    for _ in range(500):
        history.push(wind, DT)
    grown = tracemalloc.take_snapshot().compare_to(before, 'filename')
    tracemalloc.stop()
    assert (
        sum(each.size_diff for each in grown if 'gust_travel' in each.traceback[0].filename) < 1000
    )


def test_a_copy_is_never_taken_in_the_middle_of_a_step(monkeypatch):
    history, copies = GustHistory([[40.0, 0.0, 0.0]], np.zeros(3)), []
    delayed(history, np.tile([8.0, 0.0, 0.0], (600, 1)))
    reader = threading.Thread(target=lambda: copies.append(history.recent(history.time)))
    added = WindHistory.add

    def slowly(own, *given):
        last = own._run[int(own._at[0])]
        last[1] += 100.0  # half a step, which changes no index
        reader.start()
        reader.join(0.2)
        assert not copies
        last[1] -= 100.0
        added(own, *given)

    monkeypatch.setattr(WindHistory, 'add', slowly)
    history.push((8.0, 0.0, 0.0), DT)
    reader.join(10.0)
    assert np.reshape(copies[0]['wind'], (-1, 3)) == pytest.approx(np.tile([8.0, 0, 0], (200, 1)))


@pytest.mark.parametrize(
    'change', [{'mean': [1.0]}, {'delay': [1.0, 2.0]}, {'wind': [1.0] * 4}, {'wind': ['x'] * 3}]
)
def test_a_received_history_of_a_wrong_form_is_refused(change):
    history = GustHistory([[40.0, 0.0, 0.0]], np.zeros(3))
    given = {'mean': [8.0, 0.0, 1.0], 'delay': [5.0], 'wind': [8.0, 0.0, 0.0]} | change
    with pytest.raises(ParameterError):
        history.go_on(**given)
    history.go_on([8.0, 0.0, 1.0], [5.0], [8.0, 0.0, 0.0])
    assert history.recent(history.time)['delay'] == [5.0]


def test_reset_forgets():
    history = GustHistory([[30.0, 5.0, 0.0]], np.zeros(3))
    first = delayed(history, gusts(500))
    history.reset()
    assert (delayed(history, gusts(500)) == first).all()


@pytest.mark.parametrize(
    ('wind', 'dt'),
    [
        ((np.nan, 0, 0), DT),
        ((np.inf, 0, 0), DT),
        ((1, 0, 0), 0.0),
        ((1, 0, 0), -1.0),
        ((1, 0), DT),
    ],
)
def test_what_would_poison_the_history_is_refused(wind, dt):
    history = GustHistory([[10.0, 0.0, 0.0]], np.zeros(3))
    with pytest.raises(ParameterError):
        history.push(wind, dt)
    assert (delayed(history, np.ones((3, 3))) == 1.0).all()


@pytest.mark.parametrize(
    'wrong',
    [
        {'places': [[np.nan, 0, 0]]},
        {'convection_ratio': 0.0},
        {'averaging_time': 0.0},
        {'capacity': 1},
    ],
)
def test_a_history_that_cannot_be_is_refused(wrong):
    with pytest.raises(ParameterError):
        GustHistory(**({'places': [[0.0, 0.0, 0.0]]} | wrong))
