# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Samples as JSON: the forms that are read, and whatever else arrives."""

from __future__ import annotations

import json
import math
import socket
import time
from typing import Any

import numpy as np
import pytest

from tree_sway.errors import ParameterError
from tree_sway.files.wind import Refusal
from tree_sway.live.motion.live_motion import LiveMotion
from tree_sway.live.motion.motion_json import read_motion_json
from tree_sway.live.motion.motion_reading import MotionReading
from tree_sway.live.motion.motion_registry import open_motion
from tree_sway.live.motion.sender_clock import SenderClock
from tree_sway.live.transports.transport import Message

FORCE, SPIN = (0.1, -0.2, 9.8), (0.01, 0.02, 0.03)


def read(document: Any) -> Any:
    return read_motion_json(Message(json.dumps(document).encode()))


@pytest.mark.parametrize(
    'document',
    [
        {'t': 1.5, 'ax': 0.1, 'ay': -0.2, 'az': 9.8, 'gx': 0.01, 'gy': 0.02, 'gz': 0.03},
        {'time': '1.5', 'accX': 0.1, 'accY': -0.2, 'accZ': 9.8,
         'gyroX': 0.01, 'gyroY': 0.02, 'gyroZ': 0.03},
        {'timestamp': 1.5, 'acceleration': list(FORCE), 'gyro': list(SPIN), 'battery': 71},
        {'t_s': 1.5, 'linear_acceleration': {'x': 0.1, 'y': -0.2, 'z': 9.8},
         'angular_velocity': {'x': 0.01, 'y': 0.02, 'z': 0.03}},
        [{'id': 'esp32', 'data': {'t': 1.5, 'accel': list(FORCE), 'gyroscope': list(SPIN)}}],
    ],
)  # fmt: skip
def test_usual_forms_are_read(document: Any) -> None:
    assert read(document) == [MotionReading(1.5, FORCE, SPIN)]


def test_an_orientation_has_four_numbers() -> None:
    turn = (0.0, 0.0, 0.6, 0.8)
    for document in ({'q': list(turn)}, {'qx': 0.0, 'qy': 0.0, 'qz': 0.6, 'qw': 0.8},
                     {'orientation': {'x': 0.0, 'y': 0.0, 'z': 0.6, 'w': 0.8}}):  # fmt: skip
        assert read(document) == [MotionReading(None, orientation=turn)]


def test_what_is_no_number_is_kept_for_the_sensor_to_refuse() -> None:
    (found,) = read({'ax': None, 'ay': 'x', 'az': float('nan')})
    assert all(math.isnan(each) for each in found.acceleration)


@pytest.mark.parametrize(
    ('document', 'cause'),
    [
        ({'ax': 1.0, 'ay': 2.0}, 'acceleration without all of its axes'),
        ({'t': 'soon', 'acc': [0, 0, 9.8]}, 'its time is neither a number nor a date'),
        ([{'acc': [0, 0, 9.8]}] * 501, 'more than 500 samples'),
    ],
)
def test_halves_are_refused(document: Any, cause: str) -> None:
    (found,) = read(document)
    assert isinstance(found, Refusal)
    assert cause in found.reason


@pytest.mark.parametrize(
    'data',
    [
        b'', b'\xff\xfe', b'5', b'null', b'"ax"', b'[[[]]]', b'{"ax": {"ax": {"ax": {}}}}',
        b'{"wind_speed": 5}', b'[' * 100_000, b'{"acc": [1, 2]}', b'{"": 1, "x": 2}',
        b'{"' + b'a' * 100_000 + b'": 1}', b'{"acc": {"x": 1}}'[:9],
    ],
)  # fmt: skip
def test_anything_else_is_no_motion(data: bytes) -> None:
    assert read_motion_json(Message(data)) == []


@pytest.mark.parametrize('ticks', [1.0, 1e3, 1e6, 1e9])
def test_the_unit_of_a_clock_is_found_and_its_lead_taken_off(ticks: float) -> None:
    clock, told = SenderClock(), []
    for k in range(400):
        at = 0.01 * k
        if clock.note(ticks * (7.0 + at), 100.0 + at + 0.02 * (k % 3 + 1)):
            told.append(clock.local(ticks * (7.0 + at)) - (100.0 + at))
    assert clock.ticks == ticks
    # The smallest delay stays in the times, as no arrival tells of it.
    assert told[-1] == pytest.approx(0.02, abs=1e-9)


def test_a_clock_of_another_unit_is_told_with_the_cure() -> None:
    clock = SenderClock()
    assert not any(clock.note(20.0 * k, 0.05 * k) for k in range(60))
    assert 'send the time in s, ms, us or ns' in clock.problem


def test_a_clock_that_jumps_is_compared_again_when_the_jump_lasts() -> None:
    clock = SenderClock(1.0)
    assert clock.note(5.0, 100.0)
    assert not clock.note(500.0, 100.1)
    assert clock.note(5.2, 100.2)
    known = [clock.note(50.0 + 0.1 * k, 101.0 + 0.1 * k) for k in range(40)]
    assert known.index(True) == pytest.approx(30, abs=1)
    assert clock.jumps == 1
    assert clock.local(54.0) == pytest.approx(105.0)


def test_a_clock_that_drifts_is_followed() -> None:
    clock = SenderClock(1.0)
    for k in range(2400):
        clock.note(0.1 * k * (1.0 + 1e-4), 0.1 * k)
    assert clock.local(240.0 * (1.0 + 1e-4)) == pytest.approx(240.0, abs=0.01)


def test_samples_of_messages_that_come_late_keep_their_order() -> None:
    clock, told = SenderClock(1.0), list[float]()
    stamps = 0.01 * np.arange(1, 301)
    for batch in np.split(stamps, 10):
        arrival = max(batch[-1], 1.2)  # the network was held up at first
        clock.note(batch[-1], arrival, batch[0])
        told += map(clock.local, batch.tolist())
    assert np.diff(told).min() > 0.0
    assert told[-1] - told[0] < stamps[-1] - stamps[0]  # the delay is being taken off


def test_a_time_may_be_a_date() -> None:
    sample = {'timestamp': '2026-05-03T12:00:00.250+02:00', 'acc': [0, 0, 9.8]}
    (reading,) = read_motion_json(Message(json.dumps(sample).encode()))
    assert isinstance(reading, MotionReading)
    assert reading.time == 1777802400.25


def test_quantities_in_messages_of_their_own_are_told(sense: Any) -> None:
    with socket.create_server(('127.0.0.1', 0)) as probe:
        port = probe.getsockname()[1]
    sensed = sense(f'udp:{port}')
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:

        def send() -> None:
            for sample in ({'acc': [0, 0, 9.8]}, {'gyro': [0, 0, 0.1]}):
                sender.sendto(json.dumps(sample).encode(), ('127.0.0.1', port))

        sensed.until(lambda: len(sensed.samples) > 5 and len(sensed.live.refused) > 0, send)
    assert list(sensed.live.refused) == ['angular rate alone: send all of a sample in one message']


@pytest.mark.parametrize('host', ['127.0.0.1', '127.0.0.2'])
def test_samples_come_over_udp_and_only_of_one_sender(sense: Any, host: str) -> None:
    with socket.create_server(('127.0.0.1', 0)) as probe:
        port = probe.getsockname()[1]
    sensed = sense(f'udp:{port}')
    with (
        socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as ours,
        socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other,
    ):
        other.bind((host, 0))
        name = f'another sender, {host}:{other.getsockname()[1]}'

        def send() -> None:
            millis = round(1e3 * time.monotonic())
            sample = {'t': millis, 'ax': 0.0, 'ay': 0.0, 'az': 9.8}
            ours.sendto(json.dumps(sample).encode(), ('127.0.0.1', port))
            if sensed.samples:
                other.sendto(json.dumps(sample | {'az': 99.0}).encode(), ('127.0.0.1', port))

        sensed.until(lambda: sensed.live.refused.get(name, 0) > 20, send)
    assert {each.acceleration[2] for each in sensed.samples} == {9.8}
    at = time.monotonic() - sensed.samples[-1].time
    assert -0.1 < at < 5.0
    assert sensed.live.state == 'live'
    assert name.rpartition(' ')[2] in sensed.live.note
    assert [each for each in sensed.said if name in each]
    assert len(sensed.said) < 6


def feed(live: LiveMotion, *documents: Any, origin: str = 'phone') -> None:
    for each in documents:
        live._take(Message(json.dumps(each).encode(), origin))


def test_a_stranger_that_came_first_gives_way(monkeypatch: pytest.MonkeyPatch) -> None:
    now = 0.0
    monkeypatch.setattr(time, 'monotonic', lambda: now)
    live = LiveMotion(open_motion('udp:5006'), print)
    feed(live, {'acc': [0, 0, 1.0]}, origin='stranger')
    feed(live, {'acc': [0, 0, 1.0]}, origin='stranger')
    for k in range(400):
        now = 0.01 * (k + 1)
        feed(live, {'acc': [0, 0, 9.8]})
    came = [each.acceleration for each in live.drain()]
    assert came[:2] == [(0.0, 0.0, 1.0)] * 2
    assert set(came[2:]) == {(0.0, 0.0, 9.8)}
    assert 190 < len(came) < 210
    assert live.refused == {'another sender, phone': 402 - len(came)}


def test_a_phone_whose_gyroscope_stops_is_told_and_then_done_without(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    now = 0.0
    monkeypatch.setattr(time, 'monotonic', lambda: now)
    said: list[str] = []
    live = LiveMotion(open_motion('udp:5006'), said.append)
    for k in range(3200):
        now = 0.01 * k
        document = {'acc': [0, 0, 9.8]} | ({'gyro': [0, 0, 0.1]} if k < 200 else {})
        feed(live, document)
        if k == 290:
            assert sum(live.refused.values()) == 91
            assert 'acceleration alone' in said[-1]
    assert live.accepted > 3050
    assert live.quantities == ('acceleration',)
    assert said[-1].endswith(': samples of acceleration come')


def test_a_sensor_of_which_all_is_refused_is_not_live(monkeypatch: pytest.MonkeyPatch) -> None:
    now = 0.0
    monkeypatch.setattr(time, 'monotonic', lambda: now)
    live = LiveMotion(open_motion('udp:5006'), print)
    for k in range(1000):
        now = 0.01 * k
        feed(live, {'acc': [0, 0, 9.8]} if k < 100 else {'accx': 1.0})
    assert live.state == 'stale'
    live.link.is_up = True
    assert 'all was refused for 9 s' in live.problem


def test_messages_that_are_not_understood_are_told(sense: Any) -> None:
    with socket.create_server(('127.0.0.1', 0)) as probe:
        port = probe.getsockname()[1]
    sensed = sense(f'udp://127.0.0.1:{port}')
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as ours:
        sensed.until(
            lambda: any('none was understood' in each for each in sensed.said),
            lambda: ours.sendto(b'hello', ('127.0.0.1', port)),
        )
    assert '"ax": 0.1' in sensed.live.problem


def test_axes_are_read_in_any_case() -> None:
    force, rate = {'X': 0.1, 'Y': 0.2, 'Z': 9.8}, {'X': 0, 'Y': 0, 'Z': 1}
    document = {'Accelerometer': force, 'Gyroscope': rate}
    (reading,) = read_motion_json(Message(json.dumps(document).encode()))
    assert isinstance(reading, MotionReading)
    assert reading.acceleration == (0.1, 0.2, 9.8)
    assert reading.rate == (0.0, 0.0, 1.0)


def test_too_few_samples_are_told_with_the_cure() -> None:
    live = LiveMotion(open_motion('udp:5006'), print)
    for k in range(60):
        live._take(Message(json.dumps({'acc': [0, 0, 9.8]}).encode()))
        live._samples._times[-1] = 0.5 * k
    assert 'set 20 or more' in live.problem


@pytest.mark.parametrize(
    ('address', 'words'),
    [
        ('serial:/dev/ttyUSB0', 'is no live motion sensor'),
        ('motion.csv', 'does not begin with a kind of source'),
        ('192.168.1.23:8080', '^--motion: .*; give one of http://PHONE'),
        ('udp:', 'a port from 1 to 65535'),
        ('udp:70000', 'a port from 1 to 65535'),
        ('http://phone:8080/get', "a path '/get'"),
        ('http://phone:8080?speed=3', "no option 'speed'"),
        ('http://phone:8080?every=9', 'every'),
    ],
)
def test_addresses_that_are_none_are_refused(address: str, words: str) -> None:
    with pytest.raises(ParameterError, match=words):
        open_motion(address)


@pytest.mark.parametrize('begins', [(0.0, 5_000.0), (7_000_000.0, 20.0)])
def test_two_clocks_on_one_topic_are_named_and_one_is_followed(
    monkeypatch: pytest.MonkeyPatch, begins: tuple[float, float]
) -> None:
    now = 0.0
    monkeypatch.setattr(time, 'monotonic', lambda: now)
    said: list[str] = []
    live = LiveMotion(open_motion('mqtt://broker/tree/imu'), said.append)
    for k in range(2000):
        now = 0.01 * k
        feed(live, {'t': begins[k % 2] + 10.0 * k, 'acc': [k % 2, 0, 9.8]}, origin='tree/imu')
    assert len({each.acceleration for each in live.drain()}) == 1
    named = 'its times go back and forth, as those of two senders: give each an address of its own'
    assert live.refused[named] > 900
    assert live.note == named
    assert said.count(f'tree/imu: {named}') == 1


@pytest.mark.parametrize('delay', [0.0, 3.0])
def test_a_clock_that_is_set_or_stalls_is_that_of_one_sender(delay: float) -> None:
    clock = SenderClock()
    for k in range(6000):
        at = 0.01 * k
        stamp = at - 10.0 * (at // 20.0)  # set back by ten seconds now and then
        late = at + delay * (k % 500 < 100)  # held up, and then all at once
        clock.note(stamp, late)
        assert not clock.mixture
