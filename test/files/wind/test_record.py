# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
import pytest

from tree_sway.errors import FormatError
from tree_sway.files.wind.record import increasing, WindRows


def rows_of(times, speed=1.0):
    rows = WindRows('file')
    for number, time in enumerate(times, start=1):
        rows.add(number, time, (speed, 0.0, 0.0))
    return rows


def test_one_wrong_stamp_costs_one_sample():
    record = rows_of([0.0, 1.0, 900.0, 2.0, 3.0, -5.0, 4.0]).record()
    np.testing.assert_array_equal(record.time, [0, 1, 2, 3, 4])
    assert record.refused == 2
    assert record.first_refused == 'line 3: its time is out of order'


@settings(deadline=None)
@given(st.lists(st.floats(-1e6, 1e6), max_size=60))
def test_what_is_kept_increases_and_nothing_more_could_be(times):
    kept = np.array(times)[increasing(np.array(times))]
    assert (np.diff(kept) > 0).all()
    longest = np.ones(len(times), dtype=int)
    for i in range(len(times)):
        longest[i] = 1 + max((longest[j] for j in range(i) if times[j] < times[i]), default=0)
    assert len(kept) == longest.max(initial=0)


def test_impossible_speed_and_time_are_refused():
    rows = rows_of([0.0, 1.0])
    rows.add(7, 2.0, (0.0, 151.0, 0.0))
    rows.add(8, float('nan'), (0.0, 1.0, 0.0))
    rows.refuse(3, 'broken')
    record = rows.record()
    assert (len(record.time), record.refused) == (2, 3)
    assert record.first_refused == 'line 3: broken'


def test_no_good_row():
    rows = WindRows('file')
    rows.refuse(5, 'NAN')
    with pytest.raises(
        FormatError, match='file: no good row of wind, 1 refused; first line 5: NAN'
    ):
        rows.record()


def test_time_starts_at_zero_and_arrays_are_read_only():
    record = rows_of([10.0, 10.5, 11.0]).record(epoch=100.0)
    assert (record.time[0], record.duration, record.period, record.epoch) == (0.0, 1.0, 0.5, 110.0)
    with pytest.raises(ValueError, match='read-only'):
        record.velocity[0, 0] = 1.0


@pytest.mark.parametrize(('period', 'meanwhile'), [(0.1, 'a calm'), (300.0, 'a straight line')])
def test_a_gap_is_said_with_what_is_taken_there(period, meanwhile):
    times = [period * each for each in (*range(10), *range(50, 60))]
    (note,) = rows_of(times).record().notes
    assert note.startswith(f'no samples in {41 * period:.4g} of {59 * period:.4g} s')
    assert note.endswith(f'from {9 * period:g} s on: {meanwhile} is taken there')
    assert rows_of(times[:10]).record().notes == ()
    assert note in repr(rows_of(times).record())


def test_gusts_below_the_wind_are_doubted():
    rows = rows_of([0.0, 1.0, 2.0], speed=5.0)
    rows.gust = np.array([4.0, 3.0, 9.0])
    assert rows.record().notes == (
        'the gust is slower than the wind in 2 rows: are the columns swapped?',
    )
    rows.gust = np.array([4.0, 8.0, np.nan])
    assert rows.record().notes == ()
