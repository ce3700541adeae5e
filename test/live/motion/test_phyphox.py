# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A phone with phyphox: its buffers are found, read once each, and followed through faults."""

from __future__ import annotations

from collections.abc import Mapping
import json
import math
from typing import Any

import numpy as np
import pytest

pytest.importorskip('aiohttp', reason='aiohttp is not installed')

ACCELERATION = {'accelerometer': ('accX', 'accY', 'accZ', 'acc_time')}
LINEAR = {'linear_acceleration': ('linX', 'linY', 'linZ', 'lin_time')}
GYROSCOPE = {'gyroscope': ('gyrX', 'gyrY', 'gyrZ', 'gyr_time')}


def test_every_sample_comes_once_and_in_step(phone: Any, sense: Any) -> None:
    server = phone(ACCELERATION)
    sensed = sense(server.url)
    sensed.until(lambda: len(sensed.samples) > 200)
    times = np.array([each.time for each in sensed.samples])
    # A step is shorter where a faster message tells more of the phone's clock, never longer.
    steps = np.diff(times)
    assert np.median(steps) == pytest.approx(0.01)
    assert 0.0 < steps.min()
    assert steps.max() < 0.0101
    assert sensed.samples[0].rate is None

    def is_in_phase() -> bool:
        last = sensed.samples[-100:]
        at = np.array([each.time for each in last]) - server.began
        found = np.array([each.acceleration[0] for each in last])
        return np.abs(found - 0.5 * np.sin(np.pi * at)).max() < 0.5 * math.pi * 0.15

    # The phone's clock is known to the delay of the fastest answer so far.
    sensed.until(is_in_phase)


def test_the_rate_is_interpolated_to_the_times_of_the_acceleration(phone: Any, sense: Any) -> None:
    sensed = sense(phone(ACCELERATION | GYROSCOPE).url)
    sensed.until(lambda: len(sensed.samples) > 100)
    assert sensed.live.quantities == ('acceleration', 'rate')
    for each in sensed.samples[:100]:
        # Sine and cosine of one phase: both quantities belong to one moment.
        size = (each.acceleration[0] / 0.5) ** 2 + (each.rate[0] / 0.1) ** 2
        assert size == pytest.approx(1.0, abs=1e-3)


@pytest.mark.parametrize(
    ('sources', 'up'), [(LINEAR | GYROSCOPE, 0.0), (LINEAR | ACCELERATION, 9.81)]
)
def test_experiments_with_and_without_g_are_read(
    phone: Any, sense: Any, sources: Any, up: float
) -> None:
    sensed = sense(phone(sources).url)
    sensed.until(lambda: sensed.samples)
    assert sensed.samples[0].acceleration[2] == pytest.approx(up)


def test_a_gyroscope_that_the_phone_lacks_is_done_without(phone: Any, sense: Any) -> None:
    server = phone(ACCELERATION | GYROSCOPE)
    whole = server.get
    no_values = {'size': 0, 'updateMode': 'partial', 'buffer': []}

    def get(asked: Any) -> str:
        answer = json.loads(whole(asked))
        answer['buffer'] |= {
            name: no_values for name in GYROSCOPE['gyroscope'] if name in answer['buffer']
        }
        return json.dumps(answer)

    server.get = get
    sensed = sense(server.url)
    sensed.until(lambda: len(sensed.samples) > 50)
    assert sensed.live.quantities == ('acceleration',)


def test_cleared_data_are_followed(phone: Any, sense: Any) -> None:
    server = phone(ACCELERATION)
    sensed = sense(server.url)
    sensed.until(lambda: len(sensed.samples) > 20)
    server.clear()
    before = len(sensed.samples)
    sensed.until(lambda: len(sensed.samples) > before + 50)
    assert sensed.live.refused['its clock jumped'] > 0
    assert sensed.live._clock.jumps == 1


def test_a_paused_measurement_is_told_and_goes_on(phone: Any, sense: Any) -> None:
    server = phone(ACCELERATION)
    server.measuring = False
    sensed = sense(server.url)
    sensed.until(lambda: 'press play' in sensed.live.problem)
    assert not sensed.samples
    server.measuring = True
    sensed.until(lambda: sensed.samples)
    assert sensed.live.problem == ''


def test_an_experiment_without_motion_says_which_to_open(phone: Any, sense: Any) -> None:
    sensed = sense(phone({'light': ('light', 'a', 'b', 'light_time')}).url)
    sensed.until(lambda: "open 'Acceleration (with g)'" in sensed.live.problem)


def test_a_line_that_breaks_is_taken_up_again(phone: Any, sense: Any) -> None:
    server = phone(ACCELERATION)
    sensed = sense(server.url)
    sensed.until(lambda: len(sensed.samples) > 20)
    server.breaks = True
    sensed.until(lambda: not sensed.live.link.is_up)
    assert 'remote access' in sensed.live.link.failure
    server.breaks = False
    before = len(sensed.samples)
    sensed.until(lambda: len(sensed.samples) > before + 20)


@pytest.mark.parametrize(
    'answer',
    [
        b'', b'[]', b'{"buffer": 3}', b'<html>', b'{"buffer": {"acc_time": {"buffer": "x"}}}',
        b'{"buffer": {"acc_time": {"buffer": [1e999, {}, null, true]}, "accX": []}}',
        b'{"buffer": {"acc_time": {"buffer": [40, 41]}, "accX": {"buffer": [1]}}}',
        b'[' * 100_000,
    ],
)  # fmt: skip
def test_hostile_answers_end_nothing(phone: Any, sense: Any, answer: bytes) -> None:
    server = phone(ACCELERATION)
    server.answer = answer
    sensed = sense(server.url)
    asked = len(server.asked)
    sensed.until(lambda: len(server.asked) > asked + 3)
    assert not sensed.samples
    server.answer = None
    sensed.until(lambda: sensed.samples)


@pytest.mark.parametrize('buffer', ['acc_time', 'accY'])
def test_samples_come_once_where_the_phone_answers_while_it_writes_one(
    phone: Any, sense: Any, buffer: str
) -> None:
    server = phone(ACCELERATION)
    whole = server.get

    def get(asked: Mapping[str, str]) -> str:
        answer = json.loads(whole(asked))
        del answer['buffer'].get(buffer, {'buffer': []})['buffer'][-1:]
        return json.dumps(answer)

    server.get = get
    sensed = sense(server.url)
    sensed.until(lambda: len(sensed.samples) > 200)
    steps = np.diff([each.time for each in sensed.samples])
    assert 0.0 < steps.min()
    assert steps.max() < 0.0101


def test_values_that_are_no_numbers_are_kept_for_the_sensor_to_refuse(
    phone: Any, sense: Any
) -> None:
    sensed = sense(phone(ACCELERATION, lambda _source, _at: (math.nan, 0.0, 9.81)).url)
    sensed.until(lambda: sensed.samples)
    assert math.isnan(sensed.samples[0].acceleration[0])
