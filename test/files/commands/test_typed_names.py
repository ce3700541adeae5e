# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A wind where a tree is expected, a tree where a wind is, and what is neither."""

from __future__ import annotations

from pathlib import Path

import pytest

from tree_sway.commands.cli import main


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Folder in which the commands are typed, with an empty file and a folder of no record."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / 'empty.csv').touch()
    (tmp_path / 'mast').mkdir()
    (tmp_path / 'mast' / 'notes.txt').touch()
    return tmp_path


@pytest.mark.parametrize(
    ('line', 'words'),
    [
        ('simulate canopy', "'canopy' is a wind, not a tree; give it by --wind, as in tree-sway"),
        ('info canopy', "'canopy' is a wind, not a tree"),
        ('info empty.csv', 'info: empty.csv: an empty file'),
        ('simulate goldcrest --wind benjamina', "'benjamina' is a tree, not a wind; name it"),
        ('simulate goldcrest --wind oak', "'oak' is a tree, not a wind"),
        ('show --wind udp://:10110', "'udp://:10110' is no file; give a live source by --sensor"),
        ('show --wind open-meteo:52,13', 'give a live source by --sensor'),
        ('show --sensor canopy', "'canopy' is a recording, no live source; give it by --wind"),
        ('show --sensor empty.csv', "'empty.csv' is a recording"),
        (
            'simulate goldcrest --wind mast',
            'mast: a folder without metadata.yaml, .db3 or .mcap, so no bag of ROS 2; give a',
        ),
    ],
)
def test_what_is_of_another_kind_is_told_before_all_else(
    line: str, words: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(line.split()) == 2
    assert words in capsys.readouterr().err


def test_files_of_these_names_are_what_their_user_says(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    seedling = Path(__file__).parents[1] / 'data' / 'seedling.yaml'
    (folder / 'canopy').write_bytes(seedling.read_bytes())
    (folder / 'oak').write_text('time,u,v,w\n0,3,0,0\n1,3,0,0\n2,3,0,0\n')
    assert main('simulate canopy --wind oak -o sway.csv'.split()) == 0
    assert 'SwayRecord of seedling' in capsys.readouterr().out


@pytest.mark.parametrize('name', ['metadata.yaml', 'wind_0.mcap', 'wind_0.db3'])
def test_a_folder_of_a_bag_is_opened(
    folder: Path, name: str, capsys: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip('rosbags')
    (folder / 'mast' / name).touch()
    assert main('simulate goldcrest --wind mast -o sway.csv'.split()) == 2
    assert 'not a bag that can be read' in capsys.readouterr().err
