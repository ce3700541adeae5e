# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Cells of inventories as people fill them: units of their own, remarks of several lines."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from tree_sway.files.scenes.inventory.cell_number import cell_number
from tree_sway.files.trees.source import open_scene


def opened(tmp_path: Path, text: str) -> Any:
    path = tmp_path / 'trees.csv'
    path.write_text(text, encoding='utf-8')
    return open_scene(path)


def heights(scene: Any) -> list[float]:
    return [each.scale * each.tree.height for each in scene.trees]


def test_each_cell_has_its_own_unit(tmp_path: Path) -> None:
    rows = (
        'species,height,x,y\noak,12,0,0\noak,39 ft,10,0\noak,12 m,20,0\noak,11,30,0\noak,9,40,0\n'
    )
    scene = opened(tmp_path, rows)
    assert heights(scene) == pytest.approx([12.0, 39 * 0.3048, 12.0, 11.0, 9.0])
    assert '2 cells of height have a unit of their own' in scene.notes


def test_a_unit_of_most_cells_is_that_of_the_others(tmp_path: Path) -> None:
    rows = 'species,height,x,y\noak,40 ft,0,0\noak,39 ft,10,0\noak,12 m,20,0\noak,30,30,0\n'
    scene = opened(tmp_path, rows)
    assert heights(scene) == pytest.approx([40 * 0.3048, 39 * 0.3048, 12.0, 30 * 0.3048])
    assert '1 cells of height without a unit are taken as ft' in scene.notes


def test_a_cell_with_another_unit_than_the_header(tmp_path: Path) -> None:
    rows = 'species,height [m],dbh [cm],x,y\noak,39 ft,300 mm,0,0\noak,12,30,10,0\n'
    scene = opened(tmp_path, rows)
    assert heights(scene) == pytest.approx([39 * 0.3048, 12.0])
    assert len(scene.kinds) == 1


def test_a_remark_of_several_lines_is_one_cell(tmp_path: Path) -> None:
    rows = (
        'name,species,"height\n[m]",x,y,remark\n'
        'a,oak,12,0,0,"crown reduced\n\nin 2023, ""fungi"""\n'
        '"b\nold",oak,13,10,0,\n'
        'c,oak,14,20,0,trunk of 12"\n'
        'd,oak,15,30,0,\n'
    )
    scene = opened(tmp_path, rows)
    assert heights(scene) == pytest.approx([12.0, 13.0, 14.0, 15.0])
    assert [each.name for each in scene.trees] == ['a', 'b old', 'c', 'd']


def test_a_tree_beyond_its_habit_is_scaled(tmp_path: Path) -> None:
    scene = opened(tmp_path, 'species,height,x,y\noak,0.5,0,0\nspruce,70,10,0\noak,12,20,0\n')
    assert heights(scene) == pytest.approx([0.5, 70.0, 12.0])
    assert any('scaled from one of 1 m' in note for note in scene.notes)


@pytest.mark.parametrize('number', ['1.234,5', '1,234.5', "1'234.5", '1234.5', '1234,5'])
def test_thousands_are_no_range(number: str) -> None:
    assert cell_number(number) == (1234.5, '')
    assert cell_number(f'{number} m') == (1234.5, 'm')
