# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
import itertools
import threading

from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest

from tree_sway.errors import FormatError
from tree_sway_ros.timing.playback import Playback
from tree_sway_ros.timing.playback_thread import PlaybackThread

TIME = np.array([0.0, 0.1, 0.2, 0.4])


def test_once_through():
    events = list(Playback(TIME).events())
    assert [event.row for event in events] == [0, 1, 2, 3]
    np.testing.assert_allclose([event.time for event in events], TIME)


def test_time_goes_on_over_the_seam():
    playback = Playback(TIME, loop=True)
    events = list(itertools.islice(playback.events(), 9))
    assert [event.row for event in events] == [0, 1, 2, 3, 0, 1, 2, 3, 0]
    assert playback.round == pytest.approx(0.5)
    assert np.diff([event.time for event in events]).min() > 0.05


def test_a_start_leaves_rows_out_and_moves_the_epoch():
    playback = Playback(TIME, start=0.15, epoch=100.0)
    assert next(iter(playback.events()))[:2] == (0.0, 2)
    assert playback.epoch == pytest.approx(100_200_000_000)


def test_a_start_beyond_the_end_is_refused():
    with pytest.raises(FormatError, match='smaller start'):
        Playback(TIME, start=1.0)


def test_a_record_of_one_sample_can_loop():
    events = list(itertools.islice(Playback(TIME[:1], loop=True).events(), 3))
    assert [event.time for event in events] == [0.0, 1.0, 2.0]


def test_without_a_date_the_clock_does_not_begin_at_zero():
    assert Playback(TIME).epoch == 10**9


def test_samples_that_go_ahead_come_with_the_one_before():
    time = np.array([0.0, 0.1, 0.2, 1.0])
    events = Playback(time, clock_period=0.1, ahead=True, loop=True).events()
    told = [(e.row, round(e.due, 6)) for e in itertools.islice(events, 40) if e.row >= 0]
    assert told[:5] == [(0, 0.0), (1, 0.0), (2, 0.1), (3, 0.6), (0, 1.0)]


@given(
    st.lists(st.floats(0.001, 5.0), min_size=1, max_size=20).map(np.cumsum),
    st.floats(0.002, 0.5),
    st.booleans(),
)
def test_neither_samples_nor_the_clock_ever_go_back(time, clock_period, loop):
    playback = Playback(time - time[0], loop=loop, clock_period=clock_period)
    events = list(itertools.islice(playback.events(), 300))
    assert (np.diff([event.time for event in events]) >= 0.0).all()
    clock = [event.time for event in events if event.row < 0]
    np.testing.assert_allclose(np.diff(clock), clock_period, rtol=1e-6)


def play(playback, n, speed=1000.0, **options):
    """Take the first n of what a thread publishes."""
    published, ended = [], threading.Event()
    full = threading.Event()

    def publish(row, stamp):
        published.append((row, stamp))
        if len(published) >= n:
            full.set()

    errors = []
    options = {'may_start': lambda: True, 'publish': publish} | options
    thread = PlaybackThread(playback, speed, on_end=ended.set, on_error=errors.append, **options)
    thread.start()
    full.wait(10.0) if n else None
    thread.stop()
    return published, thread, errors


def test_with_a_clock_stamps_are_the_records_own():
    published, _, _ = play(Playback(TIME, epoch=50.0, clock_period=0.1), 8)
    rows = [(row, stamp) for row, stamp in published if row >= 0]
    assert rows == [
        (0, 50_000_000_000),
        (1, 50_100_000_000),
        (2, 50_200_000_000),
        (3, 50_400_000_000),
    ]


def test_without_a_clock_stamps_keep_the_wall_times_pace():
    published, thread, _ = play(Playback(TIME, loop=True), 40, speed=50.0)
    stamps = np.array([stamp for _, stamp in published])
    np.testing.assert_allclose(np.diff(stamps)[:3], [2e6, 2e6, 4e6], atol=2)
    assert (np.diff(stamps) > 0).all()
    assert thread.progress()['rounds'] >= 9


def test_it_waits_until_it_may_start():
    may = threading.Event()
    published, thread, _ = play(Playback(TIME), 0, may_start=may.is_set)
    assert published == []
    assert not thread._thread.is_alive()


def test_an_error_is_handed_on():
    done = threading.Event()

    def publish(row, stamp):
        raise ValueError('no')

    errors = []
    thread = PlaybackThread(
        Playback(TIME),
        1.0,
        publish=publish,
        may_start=lambda: True,
        on_end=done.set,
        on_error=lambda error: (errors.append(error), done.set()),
    )
    thread.start()
    assert done.wait(10.0)
    thread.stop()
    assert str(errors[0]) == 'no'
