# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Two senders behind one name are told by their speeds; one instrument never is."""

from __future__ import annotations

import numpy as np
import pytest

from test.live.test_two_instruments import Two
from tree_sway.live.every_other import EveryOther
from tree_sway.live.transports.transport import Message

TOPIC = 'garden/wind'


@pytest.fixture
def two(monkeypatch: pytest.MonkeyPatch) -> Two:
    return Two(monkeypatch, f'mqtt://broker/{TOPIC}')


def gusty(rng: np.random.Generator, mean: float, intensity: float, n: int, dt: float):
    """Speeds [m/s] of one instrument each dt [s], whose gusts last five seconds."""
    kept = np.exp(-dt / 5.0)
    gust = 0.0
    found = np.empty(n)
    for k in range(n):
        gust = kept * gust + np.sqrt(1.0 - kept**2) * rng.normal()
        found[k] = max(0.0, mean * (1.0 + intensity * gust))
    return found


def told(speeds) -> EveryOther:
    looked = EveryOther()
    for speed in speeds:
        looked.note(float(speed))
    return looked


@pytest.mark.parametrize('dt', [0.05, 1.0, 16.0, 60.0])
@pytest.mark.parametrize('mean', [1.0, 3.0, 8.0, 20.0])
def test_gusts_of_one_instrument_are_never_told(mean: float, dt: float) -> None:
    rng = np.random.default_rng(41)
    assert told(gusty(rng, mean, 0.3, 20_000, dt)).total == 0
    assert told(np.round(gusty(rng, mean, 0.3, 20_000, dt), 1)).total == 0


@pytest.mark.parametrize('step', [0.1, 0.667, 1.0, 1.75, 3.5])
@pytest.mark.parametrize('intensity', [0.0, 0.03, 0.1, 0.25])
def test_a_cup_that_counts_is_never_told(step: float, intensity: float) -> None:
    rng = np.random.default_rng(42)
    for mean in (1.0, 1.5 * step, 2.5 * step, 8.0):
        turned = np.cumsum(gusty(rng, mean, intensity, 6_000, 1.0)) / step
        assert told(step * np.diff(np.floor(turned))).total == 0


@pytest.mark.parametrize('steady', [5.0, 0.0])
def test_a_steady_instrument_and_a_calm_are_never_told(steady: float) -> None:
    assert told([steady] * 640).total == 0


@pytest.mark.parametrize(('one', 'other'), [(3.0, 8.0), (3.0, 6.0), (5.0, 12.0)])
def test_two_instruments_in_different_wind_are_told(one: float, other: float) -> None:
    rng = np.random.default_rng(43)
    both = np.stack([gusty(rng, mean, 0.15, 640, 1.0) for mean in (one, other)], axis=1).ravel()
    assert told(both).total > 320


def test_two_publishers_of_one_topic_are_counted_and_named(
    two: Two, monkeypatch: pytest.MonkeyPatch
) -> None:
    said: list[str] = []
    monkeypatch.setattr(two.wind, '_log', said.append)
    two.alternate(Message(b'5.0', TOPIC), Message(b'9.0', TOPIC))
    assert two.wind.every_other.total == 192
    (line,) = [text for text in said if 'two senders' in text]
    assert line.startswith(f'{TOPIC}: every other message is faster (5.0 and 9.0 m/s)')
    assert 'an address of its own' in line


def test_it_is_over_when_the_second_one_has_gone(two: Two) -> None:
    two.alternate(Message(b'5.0', TOPIC), Message(b'9.0', TOPIC))
    assert two.wind.every_other.problem
    two.alternate(Message(b'5.0', TOPIC), Message(b'5.1', TOPIC))
    assert not two.wind.every_other.problem
