# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What a stream was like, from what arrived of it."""

from __future__ import annotations

import math
import re
import tracemalloc

import numpy as np
import pytest

from tree_sway_ros.commands.text import status_line, summary
from tree_sway_ros.commands.totals import StreamTotals

STAMPS = [k / 60 for k in range(121) if k != 50]
WINDS = [0.05 * k for k in range(41)]
TIP, WIND = np.array([0.003, 0.0, 0.004]), np.array([3.0, 4.0, 0.0])


@pytest.fixture
def totals() -> StreamTotals:
    """Count the same stream as it came."""
    made = StreamTotals()
    for stamp in STAMPS:
        made.add_poses(stamp + 0.001, stamp, TIP)
    for stamp in WINDS:
        made.wind.add(stamp, WIND)
    return made


def test_rates_latency_and_what_is_missing(totals: StreamTotals) -> None:
    assert totals.poses.rate == pytest.approx(59.5)
    assert totals.wind.rate == pytest.approx(20.0)
    assert totals.latency(0.5) == pytest.approx([0.001])
    assert totals.missing(60.0) == 1
    assert totals.missing(30.0) < 0  # more came than should have: the rate asked for is another


def test_nothing_has_no_rate_and_no_latency() -> None:
    totals = StreamTotals()
    assert (totals.poses.rate, totals.wind.rate, totals.missing(60.0)) == (0.0, 0.0, 0)
    assert math.isnan(totals.latency(0.5)[0])
    assert summary(totals, 60.0) == 'no poses'


def test_latencies_are_those_of_the_latest_poses() -> None:
    totals = StreamTotals()
    for late in np.random.default_rng(5).permutation(20_001):
        totals.add_poses(1e-6 * late, 0.0, TIP)
    assert totals.latency(0.05, 0.5, 1.0) == pytest.approx([1e-3, 0.01, 0.02])


def test_a_day_of_a_stream_takes_no_more_memory_than_a_second() -> None:
    def growth(first: int, more: int) -> int:
        """Memory that the frames after the first ones take."""
        sizes, totals = [], StreamTotals()
        tracemalloc.start()
        for begin, end in ((0, first), (first, first + more)):
            for frame in range(begin, end):
                totals.add_poses(frame / 60, frame / 60, TIP)
            sizes.append(tracemalloc.get_traced_memory()[0])
        tracemalloc.stop()
        return sizes[1] - sizes[0]

    # The latest 36,000 are kept. Other threads of the process may take some memory just then, but
    # not each time.
    assert any(growth(37_000, 5_000) < 200 for _ in range(3))


def test_a_line_about_now(totals: StreamTotals) -> None:
    line = status_line(totals, 2.0)
    assert 'wind  5.0 m/s from SW at 20.0 Hz' in line
    assert 'tip    5.0 mm' in line
    assert re.search(r'poses  59.5 Hz, latency (0.99|1.0\d) ms \(p95 (0.99|1.0\d)\)', line)
    assert status_line(StreamTotals(), 2.0).startswith('   2.0 s | no wind | poses   0.0 Hz')


@pytest.mark.parametrize(
    ('to', 'name'),
    [
        ((1, 0), 'W'),
        ((0, 1), 'S'),
        ((-1, 0), 'E'),
        ((0, -1), 'N'),
        ((1, -1), 'NW'),
        ((0, 0.01), None),
    ],
)
def test_winds_are_named_by_where_they_come_from(
    to: tuple[float, float], name: str | None
) -> None:
    totals = StreamTotals()
    totals.wind.add(0.0, np.array([*to, 0.0]))
    assert (f'from {name} at' if name else 'calm at') in ' '.join(status_line(totals, 0.0).split())


def test_a_summary_says_it_all(totals: StreamTotals) -> None:
    text = summary(totals, 60.0)
    assert 'poses    120 at 59.50 Hz (wanted 60), 1 missing' in text
    assert re.search(r'latency  p50 (0.99|1.0\d), p95 (0.99|1.0\d), max 1.00 ms', text)
    assert 'mean 5.00, max 5.00 m/s, from SW' in text
    assert 'mean +3.0 east, +0.0 north, +4.0 up' in text
    whole = StreamTotals()
    for stamp in STAMPS[:50]:
        whole.add_poses(stamp, stamp, TIP)
    assert 'none missing' in summary(whole, 60.0)
