# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Tables that are written as their rows come: none without a row, and a full disk is told."""

from __future__ import annotations

import math
from pathlib import Path
import socket
import time

import pytest

from tree_sway.commands.cli import main
from tree_sway.commands.row_file import RowFile
from tree_sway.errors import FormatError

FULL = Path('/dev/full')


def test_a_row_is_on_the_disk_when_it_is_written(tmp_path: Path) -> None:
    path = tmp_path / 'wind.csv'
    rows = RowFile(path)
    assert not path.exists()
    for value in ('1', '2'):
        rows.write(['time', 'u'], [value, value])
    assert path.read_text() == 'time,u\n1,1\n2,2\n'
    assert rows.count == 2
    rows.close()


@pytest.mark.parametrize(('seconds', 'is_said'), [(60.0, True), (3.0, False), (math.inf, False)])
def test_rows_of_a_shorter_time_than_asked_are_said(
    seconds: float,
    is_said: bool,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capfd: pytest.CaptureFixture[str],
) -> None:
    now = iter([10.0, 11.0, 12.0])
    monkeypatch.setattr(time, 'monotonic', lambda: next(now))
    rows = RowFile(tmp_path / 'wind.csv')
    for value in '123':
        rows.write(['time', 'u'], [value, value])
    rows.close()
    rows.say_short(seconds)
    said = 'note: wind.csv has 3 s of the 60 s that were asked for\n'
    assert capfd.readouterr().err == (said if is_said else '')


def test_a_first_row_that_is_held_back_counts_from_when_it_came(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    now = iter([10.0, 12.0, 12.0])
    monkeypatch.setattr(time, 'monotonic', lambda: next(now))
    rows = RowFile(tmp_path / 'wind.csv')
    rows.hold()
    for value in '12':
        rows.write(['time', 'u'], [value, value])
    rows.close()
    rows.say_short(60.0)
    assert capfd.readouterr().err == 'note: wind.csv has 4 s of the 60 s that were asked for\n'


def test_without_a_row_an_older_file_stays(tmp_path: Path) -> None:
    path = tmp_path / 'wind.csv'
    path.write_text('older')
    RowFile(path).close()
    assert path.read_text() == 'older'


@pytest.mark.skipif(not FULL.exists(), reason='a disk that is full is a device of Linux')
def test_a_full_disk_ends_a_table() -> None:
    rows = RowFile(FULL)
    for _ in range(3):
        rows.write(['time'], ['1'])
    assert rows.failure == 'No space left on device'
    with pytest.raises(FormatError, match='after 0 rows: No space left on device; make room'):
        rows.close()


def test_a_record_without_wind_says_why_and_leaves_an_older_one(tmp_path: Path, capsys) -> None:
    path = tmp_path / 'wind.csv'
    path.write_text('older')
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
        free.bind(('127.0.0.1', 0))
        address = f'udp://127.0.0.1:{free.getsockname()[1]}'
    line = ['record', '--sensor', address, '-o', str(path), '--seconds', '1', '--force']
    assert main(line) == 2
    said = capsys.readouterr().err
    assert 'nothing has come yet' in said.splitlines()[-1]
    assert path.read_text() == 'older'
