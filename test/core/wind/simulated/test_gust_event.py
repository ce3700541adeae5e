# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
import math

from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest

from tree_sway.core.wind.simulated.gust_event import EVENT_KINDS, GustEvent, with_events
from tree_sway.errors import ParameterError

TIME = np.linspace(-5.0, 60.0, 6501)
EAST = 0.5 * math.pi


@pytest.mark.parametrize('kind', ['one_minus_cos', 'extreme_operating_gust'])
def test_a_gust_happens_again(kind):
    event = GustEvent(kind, 3.0, 4.0, start=2.0, every=10.0)
    once = GustEvent(kind, 3.0, 4.0, start=2.0)
    first = (TIME >= 2.0) & (TIME < 12.0)
    for cycle in range(5):
        again = event.at(TIME[first] + 10.0 * cycle)
        np.testing.assert_allclose(again, once.at(TIME[first]), atol=1e-9)
    assert not event.at(TIME[TIME < 2.0]).any()


@pytest.mark.parametrize('kind', ['step', 'direction_change', 'turn'])
def test_what_lasts_goes_there_and_back(kind):
    event = GustEvent(kind, 3.0, 4.0, start=2.0, every=10.0)
    np.testing.assert_allclose(
        event.at([0.0, 11.9, 21.9, 31.9, 41.9]), (0, 3, 0, 3, 0), atol=1e-12
    )
    assert np.abs(np.diff(event.at(TIME))).max() < 0.02


@given(
    st.sampled_from(EVENT_KINDS),
    st.floats(-3.0, 3.0),
    st.floats(0.5, 5.0),
    st.floats(0.0, 10.0),
    st.floats(5.0, 20.0),
)
def test_repeats_never_jump(kind, amplitude, duration, start, every):
    value = GustEvent(kind, amplitude, duration, start, every).at(TIME)
    largest_slope = 7.0 * abs(amplitude) / duration
    assert np.abs(np.diff(value)).max() <= largest_slope * (TIME[1] - TIME[0]) + 1e-9


@pytest.mark.parametrize(
    ('values', 'match'),
    [
        (('whirl', 1.0, 1.0), "unknown event 'whirl'.*one_minus_cos"),
        (('one_minus_cos', math.nan, 1.0), 'amplitude'),
        (('turn', math.nan, 1.0), 'angle'),
        (('turn', 1.0, 0.0), 'duration'),
        (('step', 1.0, -1.0), 'duration'),
        (('step', 1.0, 0.0, math.inf), 'start'),
        (('one_minus_cos', 1.0, 5.0, 0.0, 4.0), 'every: 4.0 is out of range'),
        (('one_minus_cos', 1.0, 5.0, 0.0, -1.0), 'every'),
        (('step', 1.0, 0.0, 0.0, math.nan), 'every'),
    ],
)
def test_what_cannot_be_is_refused(values, match):
    with pytest.raises(ParameterError, match=match):
        GustEvent(*values)


class TestWithEvents:
    base = np.tile([5.0, 0.0, 0.5], (len(TIME), 1))

    def test_none_leaves_the_wind(self):
        wind = with_events(TIME, self.base, (), EAST)
        np.testing.assert_array_equal(wind, self.base)
        assert wind is not self.base

    def test_speeds_add_along_the_mean(self):
        events = (GustEvent('step', 2.0, 0.0, 10.0), GustEvent('step', 1.0, 0.0, 20.0))
        wind = with_events(TIME, self.base, events, EAST)
        np.testing.assert_allclose(wind[-1], (8.0, 0.0, 0.5), atol=1e-14)
        to_the_north = with_events(TIME, self.base, events, 0.0)
        np.testing.assert_allclose(to_the_north[-1], (5.0, 3.0, 0.5), atol=1e-14)

    def test_a_positive_turn_goes_counter_clockwise_seen_from_above(self):
        wind = with_events(TIME, self.base, (GustEvent('turn', EAST, 5.0),), EAST)
        np.testing.assert_allclose(wind[-1], (0.0, 5.0, 0.5), atol=1e-14)

    def test_a_turn_keeps_speeds_and_carries_gusts(self):
        events = (GustEvent('turn', 1.0, 5.0), GustEvent('one_minus_cos', 4.0, 6.0, 20.0))
        wind = with_events(TIME, self.base, events, EAST)
        speed = np.hypot(wind[:, 0], wind[:, 1])
        np.testing.assert_allclose(speed, 5.0 + events[1].at(TIME), atol=1e-12)
        np.testing.assert_allclose(wind[:, 2], 0.5)

    def test_order_does_not_matter(self):
        events = [GustEvent(kind, 0.7, 5.0, 3.0 * i) for i, kind in enumerate(EVENT_KINDS)]
        there = with_events(TIME, self.base, events, 1.0)
        back = with_events(TIME, self.base, events[::-1], 1.0)
        np.testing.assert_allclose(there, back, atol=1e-12)

    def test_one_sample_or_many(self):
        events = [GustEvent(kind, 0.7, 5.0, 3.0 * i) for i, kind in enumerate(EVENT_KINDS)]
        many = with_events(TIME, self.base, events, 1.0)
        one = with_events(TIME[1234], self.base[1234], events, 1.0)
        assert one.shape == (3,)
        np.testing.assert_allclose(one, many[1234], atol=1e-14)
