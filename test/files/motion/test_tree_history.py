# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A table over days of what motion sensors tell about a tree."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest

from tree_sway.errors import FormatError, ParameterError
from tree_sway.files.motion.tree_history import TreeHistory
from tree_sway.files.trees.source import open_tree
from tree_sway.twin.observed_tree import ObservedTree
from tree_sway.twin.sway_watch import SwayChange
from tree_sway.twin.tree_fit import TreeFit


def rows_of(path: Path) -> list[dict[str, str]]:
    with path.open(encoding='utf-8', newline='') as file:
        return list(csv.DictReader(file))


def test_rows_are_means_of_ten_minutes_and_go_on_in_another_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / 'oak.csv'
    for run in (1, 2):
        at = {'phone': 'segment:3'}
        twin = ObservedTree(open_tree('goldcrest'), at=at, has_band=True)
        twin.step((3.0, 4.0, 0.0), 1.0 / 60.0)
        twin.step((3.0, 4.0, 0.0), 1.0 / 60.0)
        history = TreeHistory(str(path), ['phone'])
        (track,) = twin.observer.tracks
        assert not any(history.note(twin, 5000.0 + second) for second in range(0, 300, 5))
        monkeypatch.setattr(track.native, 'excess', 9.0)
        monkeypatch.setattr(track.native, 'in_use', 1)
        fit = TreeFit(0.8, 1.2, 0.02, 0.2, 0.9, 0.2, 1.0)
        monkeypatch.setattr(twin.observer._fit, 'found', fit)
        monkeypatch.setattr(twin.observer._fit.watches[0], 'change', SwayChange(1.2, 0.02, 2.0))
        assert sum(history.note(twin, 5000.0 + second) for second in range(300, 605, 5)) == 1
        rows = rows_of(path)
        assert len(rows) == run
    last = rows[-1]
    assert last['time'].endswith('Z')
    assert float(last['wind [m/s]']) == pytest.approx(5.0)
    assert float(last['phone: in use [-]']) == pytest.approx(0.5, abs=0.02)
    assert float(last['phone: residual [-]']) == pytest.approx(2.0, abs=0.03)
    assert float(last['phone: frequencies over those before [-]']) == 1.2
    assert float(last['stiffness [-]']) == 0.8
    assert float(last['band from [m]']) <= 0.0 <= float(last['band to [m]'])


def test_a_table_that_cannot_be_gone_on_with_is_refused(tmp_path: Path) -> None:
    path = tmp_path / 'oak.csv'
    path.write_text('time,u\n', encoding='utf-8')
    with pytest.raises(FormatError, match='has other columns'):
        TreeHistory(str(path), ['phone'])
    assert path.read_text(encoding='utf-8') == 'time,u\n'
    with pytest.raises(FormatError, match='no such folder'):
        TreeHistory(str(tmp_path / 'none' / 'oak.csv'), ['phone'])
    with pytest.raises(ParameterError, match='no motion sensor'):
        TreeHistory(str(path), [])


def test_a_row_that_a_full_disk_cut_off_stays_alone(tmp_path: Path) -> None:
    path = tmp_path / 'oak.csv'
    twin = ObservedTree(open_tree('goldcrest'), at={'phone': 'segment:3'})
    for _ in range(2):
        history = TreeHistory(str(path), ['phone'])
        history.note(twin, 0.0)
        assert history.note(twin, 600.0)
        whole = path.read_bytes()
        path.write_bytes(whole[:-4])
    rows = rows_of(path)
    assert len(rows) == 2
    assert all(row['time'].endswith('Z') and None not in row for row in rows)


@pytest.mark.parametrize(
    'content',
    [b'\xff\xfe', b'\x00' * 9, b'"' + b'a' * 200_000, b'time' + b'a' * 200_000, b'\n', b'\r,'],
)
def test_a_damaged_table_is_refused_by_its_name_with_a_cure(
    tmp_path: Path, content: bytes
) -> None:
    path = tmp_path / 'oak.csv'
    path.write_bytes(content)
    with pytest.raises(FormatError, match=r'oak\.csv: has other columns; name another file'):
        TreeHistory(str(path), ['phone'])
    assert path.read_bytes() == content


@pytest.mark.usefixtures('little_effort')
def test_of_a_huge_table_only_the_first_line_is_read(tmp_path: Path) -> None:
    path = tmp_path / 'oak.csv'
    TreeHistory(str(path), ['phone'])
    path.touch()
    with path.open('r+b') as file:
        file.truncate(2**33)
    with pytest.raises(FormatError, match='has other columns'):
        TreeHistory(str(path), ['phone'])
