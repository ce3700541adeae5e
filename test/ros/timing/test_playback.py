# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
import itertools
import threading

from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest

from tree_sway.errors import FormatError
from tree_sway_ros.timing import playback as playing
from tree_sway_ros.timing.playback import LONGEST_CLOCK_STEP, Playback

TIME = np.array([0.0, 0.1, 0.2, 0.4])


def playback(time=TIME, publish=lambda row, stamp: None, **options):
    """Make a playback with a listener, of which the end is not asked."""
    heard = {'may_start': lambda: True, 'on_end': lambda: None, 'on_error': lambda error: None}
    return Playback(time, publish, **(heard | options))


def test_once_through():
    events = list(playback().events())
    assert [row for _, row in events] == [0, 1, 2, 3]
    np.testing.assert_allclose([time for time, _ in events], TIME)


def test_time_goes_on_over_the_seam():
    made = playback(loop=True)
    events = list(itertools.islice(made.events(), 9))
    assert [row for _, row in events] == [0, 1, 2, 3, 0, 1, 2, 3, 0]
    assert made.round == pytest.approx(0.5)
    assert np.diff([time for time, _ in events]).min() > 0.05


def test_a_start_leaves_rows_out_and_moves_the_epoch():
    made = playback(start_at=0.15, epoch=100.0)
    assert next(iter(made.events())) == (0.0, 2)
    assert made.begin == pytest.approx(100_200_000_000)


def test_a_start_beyond_the_end_is_refused():
    with pytest.raises(FormatError, match='smaller start'):
        playback(start_at=1.0)


def test_a_record_of_one_sample_can_loop():
    events = list(itertools.islice(playback(TIME[:1], loop=True).events(), 3))
    assert [time for time, _ in events] == [0.0, 1.0, 2.0]


def test_without_a_date_the_clock_does_not_begin_at_zero():
    assert playback().begin == 10**9


@given(
    st.lists(st.floats(0.001, 5.0), min_size=1, max_size=20).map(np.cumsum),
    st.floats(0.5, 1000.0),
    st.booleans(),
)
def test_neither_samples_nor_the_clock_ever_go_back(time, rate, loop):
    made = playback(time - time[0], rate=rate, loop=loop, has_clock=True)
    events = list(itertools.islice(made.events(), 300))
    assert (np.diff([time for time, _ in events]) >= 0.0).all()
    steps = np.diff([time for time, row in events if row < 0])
    np.testing.assert_allclose(steps, min(rate / 250.0, LONGEST_CLOCK_STEP), rtol=1e-6)


def play(n, **options):
    """Take the first n of what a thread publishes once time advances."""
    published, full = [], threading.Event()

    def publish(row, stamp):
        if row >= 0 or published:
            published.append((row, stamp))
        if len(published) >= n:
            full.set()

    made = playback(publish=publish, **options)
    made.start()
    full.wait(10.0) if n else None
    made.stop()
    return published, made


def test_with_a_clock_stamps_are_the_records_own():
    published, _ = play(120, epoch=50.0, has_clock=True)
    rows = [(row, stamp) for row, stamp in published if row >= 0]
    assert rows == [
        (0, 50_000_000_000),
        (1, 50_100_000_000),
        (2, 50_200_000_000),
        (3, 50_400_000_000),
    ]


def test_without_a_clock_stamps_keep_the_wall_times_pace(monkeypatch):
    monkeypatch.setattr(playing, '_LATEST', 1e3)  # however busy the machine is
    published, made = play(40, loop=True, rate=50.0)
    stamps = np.array([stamp for _, stamp in published])
    np.testing.assert_allclose(np.diff(stamps)[:3], [2e6, 2e6, 4e6], atol=2)
    assert (np.diff(stamps) > 0).all()
    assert made.progress()['rounds'] >= 9


def test_it_waits_until_it_may_start():
    may = threading.Event()
    published, made = play(0, may_start=may.is_set)
    assert published == []
    assert not made._thread.is_alive()


def test_it_waits_for_the_subscribers_of_all_that_it_plays_and_says_so(monkeypatch):
    monkeypatch.setattr(playing, '_SETTLING', 0.1)
    states = iter(['a solver'] * 5 + [''] + ['a solver'] * 5)  # one that came and went
    asked, said, begun = [], [], threading.Event()

    def lacking():
        asked.append(begun.is_set())
        return next(states, '')

    made = playback(publish=lambda row, stamp: begun.set(), lacking=lacking, say=said.append)
    made.start()
    assert begun.wait(10.0)
    made.stop()
    assert len(asked) > 11
    assert not any(asked)
    assert said == ['waiting for a solver']
    assert made.waits_for == ''


def test_it_does_not_wait_for_ever_for_the_last_subscriber_and_says_so(monkeypatch):
    monkeypatch.setattr(playing, '_LONGEST_WAIT', 0.1)
    begun, said = threading.Event(), []
    made = playback(
        publish=lambda row, stamp: begun.set(), lacking=lambda: 'a solver', say=said.append
    )
    made.start()
    assert begun.wait(10.0)
    made.stop()
    assert said == ['waiting for a solver', 'playing without a solver, after 0.1 s']


def test_an_error_is_handed_on():
    errors, done = [], threading.Event()

    def publish(row, stamp):
        raise ValueError('no')

    made = playback(publish=publish, on_error=lambda error: (errors.append(error), done.set()))
    made.start()
    assert done.wait(10.0)
    made.stop()
    assert str(errors[0]) == 'no'
