# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Records of a machine whose clock is set while they are made."""

from __future__ import annotations

from pathlib import Path
import time
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from tree_sway.files.wind import WindReading
from tree_sway.files.wind.wind_file import read_wind
from tree_sway.live.commands.record_clock import RecordClock
from tree_sway.live.commands.wind_recording import WindTable

NOON = 1_800_000_000.0
STEPS = [0.0, 0.0, -3600.0, -3600.0, 60.0, 60.0]
"""How far the clock was set in all when each row came [s]; rows come once in a second."""


@pytest.fixture
def row_times(monkeypatch: pytest.MonkeyPatch) -> Any:
    """Return times of `time.monotonic` of the rows; the clock is set meanwhile."""
    now, off = [0.0], [0.0]
    monkeypatch.setattr(time, 'monotonic', lambda: now[0])
    monkeypatch.setattr(time, 'time', lambda: NOON + now[0] + off[0])

    def times() -> Any:
        for second, step in enumerate(STEPS):
            now[0], off[0] = float(second), step
            yield now[0]

    return times


def test_dates_do_not_go_back_and_follow_a_clock_that_is_set_forward(row_times: Any) -> None:
    clock = RecordClock()
    dates = [clock.date(at) for at in row_times()]
    assert dates == pytest.approx(NOON + np.array([0.0, 1.0, 2.0, 3.0, 64.0, 65.0]))


def test_a_record_can_be_read_whole_after_the_clock_was_set_back(
    row_times: Any, tmp_path: Path
) -> None:
    table = WindTable(tmp_path / 'wind.csv')
    table.wind = cast(Any, SimpleNamespace(interval=0.0, bearing=0.0))
    for at in row_times():
        table.take(WindReading('MWV', speed=3.0 + at, bearing=0.5))
    table.close()
    record = read_wind(tmp_path / 'wind.csv')
    assert record.time - record.time[0] == pytest.approx([0.0, 1.0, 2.0, 3.0, 64.0, 65.0])
    assert not [note for note in record.notes if 'out of order' in note]
