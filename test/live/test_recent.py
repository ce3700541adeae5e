# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Samples that wait until they are taken, and their rate."""

from __future__ import annotations

import pytest

from tree_sway.live.recent import RecentSamples


def test_samples_are_taken_once_up_to_a_time() -> None:
    recent = RecentSamples[str](8)
    for at, name in enumerate('abcd'):
        recent.add(float(at), name)
    assert recent.drain(2.0) == ['a', 'b', 'c']
    assert recent.drain(2.0) == []
    assert recent.drain() == ['d']


def test_of_too_many_the_oldest_are_lost() -> None:
    recent = RecentSamples[int](3)
    for number in range(5):
        recent.add(0.1 * number, number)
    assert recent.drain() == [2, 3, 4]


def test_the_rate_is_that_of_the_newest_also_of_those_that_were_taken() -> None:
    recent = RecentSamples[int](3, counted=5)
    assert recent.rate == 0.0
    recent.add(0.0, 0)
    assert recent.rate == 0.0
    for number in range(10):
        recent.add(7.0 + 0.25 * number, number)
        recent.drain()
    assert recent.rate == pytest.approx(4.0)
    for _ in range(5):
        recent.add(20.0, 0)
    assert recent.rate == 0.0
