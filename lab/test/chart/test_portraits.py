# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Portraits and film are never older than the trees, the wind's work on them and the drawing."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest
from tree_sway_lab.chart.film import film_figures
from tree_sway_lab.chart.portraits import (
    digest_of_file,
    drawing_digest,
    figures,
    PORTRAITS,
    settled,
)

ROOT = Path(__file__).resolve().parents[3]
PICTURES = ROOT / 'doc' / 'pictures'
CURE = 'run: tree-sway lab chart portraits -o doc/pictures'


def rows() -> dict[str, dict[str, str]]:
    with (PICTURES / 'portraits.csv').open(encoding='utf-8', newline='') as file:
        return {row['picture']: row for row in csv.DictReader(file)}


def test_every_picture_is_the_one_that_was_drawn_with_this_code() -> None:
    portraits = rows()
    assert set(portraits) == {
        *(f'{name}_in_wind.png' for name in PORTRAITS),
        'benjamina_sways.gif',
    }
    for name, row in portraits.items():
        assert digest_of_file(PICTURES / name) == row['file'], CURE
        assert drawing_digest() == row['drawing'], CURE


@pytest.mark.long
@pytest.mark.parametrize('name', [*PORTRAITS, 'film'])
def test_its_trees_stand_and_sway_as_they_do_now(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(ROOT)
    row = rows()['benjamina_sways.gif' if name == 'film' else f'{name}_in_wind.png']
    now = film_figures() if name == 'film' else figures(settled(name)[1])
    assert str(now['segments']) == row['segments'], CURE
    for what in ('height', 'tip_east', 'tip_up'):
        recorded = float(row[what])
        assert float(now[what]) == pytest.approx(recorded, rel=0.02, abs=0.002), CURE


def test_a_comment_is_no_change_of_the_drawing(tmp_path: Path) -> None:
    file = tmp_path / 'a.py'
    digests = []
    for text in ('"""A."""\nx = 1\n', '"""B."""\n\nx = 1  # one\n', 'x = 2\n'):
        file.write_text(text)
        digests.append(drawing_digest([file]))
    assert digests[0] == digests[1] != digests[2]
