"""What a stream was like, from what arrived of it."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tree_sway_ros.errors import ParameterError
from tree_sway_ros.tools.stream_monitor import StreamRecord, rate_of
from tree_sway_ros.tools.stream_text import status_line, summary
from tree_sway_ros.tools.stream_watch import checked_seconds


@pytest.fixture
def record() -> StreamRecord:
    """Two seconds at 60 Hz, each pose 1 ms late and one never come; wind at 20 Hz that veers."""
    stamps = [k / 60 for k in range(121) if k != 50]
    winds = [0.05 * k for k in range(41)]
    return StreamRecord(
        arrival=[stamp + 0.001 for stamp in stamps],
        stamp=stamps,
        tip=[np.array([0.003, 0.0, 0.004])] * len(stamps),
        wind_stamp=winds,
        wind=[np.array([3.0, 4.0, 0.0])] * len(winds),
    )


def test_rates_latency_and_what_is_missing(record: StreamRecord) -> None:
    assert record.pose_rate == pytest.approx(59.5)
    assert record.wind_rate == pytest.approx(20.0)
    assert record.latency(0.5) == pytest.approx(0.001)
    assert record.missing(60.0) == 1
    assert record.missing(30.0) < 0  # more came than should have: the rate asked for is another


def test_nothing_has_no_rate_and_no_latency() -> None:
    empty = StreamRecord()
    assert (empty.pose_rate, empty.wind_rate, empty.missing(60.0)) == (0.0, 0.0, 0)
    assert math.isnan(empty.latency(0.5))
    assert rate_of([1.0, 1.0]) == 0.0
    assert summary(empty, 60.0) == "no poses"


def test_since_keeps_what_came_then(record: StreamRecord) -> None:
    latest = record.since(1.0)
    assert len(latest.arrival) == len(latest.stamp) == len(latest.tip) == 61
    assert len(latest.wind) == 21
    assert latest.missing(60.0) == 0
    assert record.since(math.inf).arrival == []


def test_a_line_about_now(record: StreamRecord) -> None:
    line = status_line(record, 2.0)
    assert "wind  5.0 m/s from SW at 20.0 Hz" in line
    assert "tip    5.0 mm" in line
    assert "poses  59.5 Hz, latency 1.00 ms (p95 1.00)" in line
    record.tip.clear()
    record.wind.clear()
    assert "wind none yet" in status_line(record, 2.0)
    assert "tip" not in status_line(record, 2.0)


@pytest.mark.parametrize(
    ("to", "name"),
    [
        ((1, 0), "W"),
        ((0, 1), "S"),
        ((-1, 0), "E"),
        ((0, -1), "N"),
        ((1, -1), "NW"),
        ((0, 0.01), None),
    ],
)
def test_winds_are_named_by_where_they_come_from(
    record: StreamRecord, to: tuple[float, float], name: str | None
) -> None:
    record.wind.append(np.array([*to, 0.0]))
    assert (f"from {name} at" if name else "calm at") in " ".join(status_line(record, 0.0).split())


def test_a_summary_says_it_all(record: StreamRecord) -> None:
    text = summary(record, 60.0)
    assert "poses    120 at 59.50 Hz (wanted 60), 1 missing" in text
    assert "mean 5.00, max 5.00 m/s, from SW" in text
    assert "mean +3.0 east, +0.0 north, +4.0 up" in text
    whole = StreamRecord(record.stamp[:50], record.stamp[:50])
    assert "none missing" in summary(whole, 60.0)


def test_a_time_to_watch() -> None:
    assert checked_seconds(None) == math.inf
    assert checked_seconds(2.5) == 2.5
    for wrong in (0.0, -1.0, math.nan):
        with pytest.raises(ParameterError, match="no time to run"):
            checked_seconds(wrong)
