# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The state of a live source of wind, on a clock of the test."""

from types import SimpleNamespace

import pytest

from tree_sway.core.wind.sensor_timing import SensorTiming
from tree_sway.live import live_source, live_wind
from tree_sway.live.live_wind import LiveWind
from tree_sway.live.registry import open_source
from tree_sway.live.transports.transport import Message

HOUR = 3600.0


class Told:
    """Live wind that is given messages at times of the test [s]."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, address: str = 'udp:5006') -> None:
        self.now = 0.0
        clock = SimpleNamespace(monotonic=lambda: self.now, time=lambda: self.now)
        for module in (live_source, live_wind):
            monkeypatch.setattr(module, 'time', clock)
        self.wind = LiveWind(open_source(address), lambda _: None)

    def tell(self, *times: float, line: bytes = b'5.0,270') -> None:
        for self.now in times:
            self.wind._receive(Message(line))

    def is_live(self, at: float) -> bool:
        self.now = at
        return self.wind.state == 'live'


@pytest.mark.parametrize('before', [[0.0], [0.0, 1.0, 2.0, 3.0], [0.0, 30.0, 60.0]])
def test_an_outage_is_not_the_period_of_an_instrument(monkeypatch, before) -> None:
    told = Told(monkeypatch)
    told.tell(*before, before[-1] + HOUR)
    last = told.now
    assert told.is_live(last + 5.0)
    assert not told.is_live(last + 200.0)


def test_a_quick_instrument_that_stops_is_not_live_for_long(monkeypatch) -> None:
    told = Told(monkeypatch)
    told.tell(*(0.1 * k for k in range(50)))
    assert told.is_live(6.5)
    assert not told.is_live(7.5)


def test_samples_that_come_in_bundles_are_live_between_them(monkeypatch) -> None:
    told = Told(monkeypatch)
    told.tell(*(6.0 * k + 0.01 * j for k in range(5) for j in range(3)))
    assert told.is_live(24.0 + 6.0)


def test_what_is_about_something_else_is_counted_for_viewers(monkeypatch) -> None:
    told = Told(monkeypatch)
    told.tell(0.0)
    told.tell(0.1, 0.2, line=b'hello')
    assert told.wind.source['other'] == 2


def test_two_outages_are_not_the_period_either(monkeypatch) -> None:
    told = Told(monkeypatch)
    told.tell(*range(10), HOUR, 2.0 * HOUR)
    assert not told.is_live(2.0 * HOUR + 60.0)


@pytest.mark.parametrize('period', [60.0, 600.0])
def test_a_slow_instrument_is_live_between_its_messages(monkeypatch, period) -> None:
    told = Told(monkeypatch)
    told.tell(0.0, period)
    assert told.is_live(3.0 * period)
    assert told.wind.interval == period
    told.tell(*(period * k for k in range(2, 8)))
    assert told.is_live(9.5 * period)
    assert not told.is_live(10.5 * period)


def test_an_hourly_instrument_is_believed_at_the_third_message(monkeypatch) -> None:
    told = Told(monkeypatch)
    told.tell(0.0, HOUR, 2.0 * HOUR)
    assert told.is_live(3.0 * HOUR)


def test_a_first_interval_of_an_hour_is_an_outage_of_a_topic_too() -> None:
    timing = SensorTiming(1.0)
    timing.note_interval(HOUR)
    assert timing.longest_live == timing.longest_hold == 1.0
    timing.note_interval(0.1)
    assert timing.period == 0.1


def test_an_instrument_that_sends_no_numbers_any_more_is_said_once_and_counted(
    hear, port, send
) -> None:
    heard = hear(f'udp://127.0.0.1:{port}')
    heard.until(lambda: heard.wind.newest, lambda: send(port, b'{"wind_speed": 5.0}\n'))
    heard.until(
        lambda: sum(heard.wind.refused.values()) > 3,
        lambda: send(port, b'{"wind_speed": "nan"}\n'),
    )
    (said,) = (each for each in heard.said if 'refused, and counted' in each)
    assert "speed is 'nan'" in said
    assert "refused: speed is 'nan'" in heard.wind.refused_text
