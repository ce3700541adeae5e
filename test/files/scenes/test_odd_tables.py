# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Inventories as spreadsheets and editors spoil them: encodings, formulas, dates, merged cells."""

from __future__ import annotations

from collections.abc import Sequence
import datetime
from pathlib import Path
from typing import Any

import pytest

from tree_sway.errors import FormatError
from tree_sway.files.trees.source import open_scene

pytestmark = pytest.mark.usefixtures('readers_in_this_process')

HEADER = ('id', 'species', 'height', 'dbh', 'x', 'y')
OAK, BIRCH, SPRUCE = (
    (1, 'oak', 12.0, 30.0, 0, 0),
    (2, 'birch', 10.0, 20.0, 10, 0),
    (3, 'spruce', 15.0, 25.0, 0, 10),
)
TEXT = 'id,species,height,dbh,x,y\n1,chêne,12,30,0,0\n2,Bouleau,10,20,10,0\n3,Épicéa,15,25,0,10\n'


def book(path: Path, *rows: Sequence[Any], merged: str = '') -> Path:
    """Write a spreadsheet."""
    openpyxl = pytest.importorskip('openpyxl', reason='openpyxl is not installed')
    written = openpyxl.Workbook()
    for row in rows:
        written.active.append(row)
    if merged:
        written.active.merge_cells(merged)
    written.save(path)
    return path


def heights(scene: Any) -> list[float]:
    return [round(each.scale * each.tree.height, 1) for each in scene.trees]


@pytest.mark.parametrize(
    'encoding',
    ['utf-8', 'utf-8-sig', 'utf-16', 'utf-16-le', 'utf-16-be', 'utf-32', 'cp1252'],
)
def test_a_table_in_any_encoding_is_the_same(tmp_path: Path, encoding: str) -> None:
    path = tmp_path / 'trees.csv'
    path.write_bytes(TEXT.encode(encoding))
    scene = open_scene(path)
    assert heights(scene) == [12.0, 10.0, 15.0]
    assert [each.species.key for each in scene.trees] == ['oak', 'birch', 'spruce']


@pytest.mark.parametrize(
    'spoiled',
    [datetime.datetime(2024, 5, 12), datetime.time(12, 30), '=6*2', '#DIV/0!'],
    ids=['date', 'time', 'formula', 'error'],
)
def test_a_height_that_is_no_number_is_told(tmp_path: Path, spoiled: Any) -> None:
    oak = (*OAK[:2], spoiled, *OAK[3:])
    scene = open_scene(book(tmp_path / 'trees.xlsx', HEADER, oak, BIRCH, SPRUCE))
    assert heights(scene)[1:] == [10.0, 15.0]
    (note,) = (each for each in scene.notes if 'those of grown trees' in each)
    assert note.startswith('1 of 3 heights')
    assert "line 2: height is '" in note


def test_formulas_that_nobody_calculated_are_named(tmp_path: Path) -> None:
    rows = [(*each[:2], f'={each[2]}', f'={each[3]}', *each[4:]) for each in (OAK, BIRCH)]
    with pytest.raises(FormatError, match=r'height is .formula =12[.]0, not calculated'):
        open_scene(book(tmp_path / 'trees.xlsx', HEADER, *rows))


@pytest.mark.parametrize(
    ('above', 'merged'),
    [(['Trees of the park', *[None] * 5], 'A1:F1'), ([None] * 6, ''), ([], '')],
    ids=['title', 'empty cells', 'empty row'],
)
def test_rows_without_trees_are_passed_over(
    tmp_path: Path, above: Sequence[Any], merged: str
) -> None:
    rows = (above, HEADER, OAK, [], BIRCH, [None] * 6, SPRUCE, [])
    scene = open_scene(book(tmp_path / 'trees.xlsx', *rows, merged=merged))
    assert heights(scene) == [12.0, 10.0, 15.0]


def test_a_column_without_a_name_has_the_one_above_it(tmp_path: Path) -> None:
    heads = ('Tree no', 'Tree', 'Size', None, None, None), (None, *HEADER[1:])
    scene = open_scene(book(tmp_path / 'trees.xlsx', *heads, ('A1', *OAK[1:]), ('A2', *BIRCH[1:])))
    assert [each.name for each in scene.trees] == ['A1', 'A2']
