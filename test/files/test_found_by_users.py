# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Names and files that users had, and what they were told."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tree_sway.commands.cli import main
from tree_sway.errors import FormatError, ParameterError
from tree_sway.files.motion.motion_file import read_motion
from tree_sway.files.trees.source import open_scene, open_tree
from tree_sway.files.wind.table import read_table_wind
from tree_sway.files.wind.wind_file import read_wind

HERE = Path(__file__).parent
G = 9.80665


def written(folder: Path, text: str, name: str = 'table.csv') -> Path:
    (folder / name).write_text(text, encoding='utf-8')
    return folder / name


@pytest.mark.parametrize(
    ('head', 'row', 'velocity'),
    [
        ('Zeit [s];v (m/s);Richtung', '{};5;270', (5.0, 0.0)),
        ('time,dir,v', '{},180,4', (0.0, 4.0)),
        ('time,u,v,dir', '{},1,2,180', (1.0, 2.0)),
    ],
)
def test_a_speed_beside_a_direction(
    tmp_path: Path, head: str, row: str, velocity: tuple[float, float]
) -> None:
    rows = '\n'.join(row.format(i) for i in range(20))
    record = read_table_wind(written(tmp_path, f'{head}\n{rows}\n'))
    np.testing.assert_allclose(record.velocity[:, :2], np.tile(velocity, (20, 1)), atol=1e-9)


def test_a_number_is_a_name_and_a_fruit_tree_is_no_tree_of_heaven(tmp_path: Path) -> None:
    rows = 'Nr;Baumart;BHD [cm];x;y\n12;Obstbaum;30;0;0\n7;Buhce;30;10;0\n'
    scene = open_scene(written(tmp_path, rows), warn=False)
    assert [each.name for each in scene.trees] == ['12', '7']
    notes = ' '.join(scene.notes)
    assert "'Obstbaum' is not in the table" in notes
    assert 'goetterbaum' not in notes
    assert "did you mean 'buche'" in notes


@pytest.mark.parametrize(
    ('column', 'cells', 'kept'),
    [
        ('status', 'ADA', ['1', '3']),
        ('status', 'AAG', ['1', '2', '3']),
        ('status', 'ABD', ['1', '2', '3']),  # grades of another list
        ('condition', 'ADA', ['1', '2', '3']),
    ],
)
def test_a_dead_tree_of_forest_geo(
    tmp_path: Path, column: str, cells: str, kept: list[str]
) -> None:
    rows = [f'{i},Fagus sylvatica,{i},1,300,{each}' for i, each in enumerate(cells, 1)]
    text = '\n'.join([f'treeID,sp,gx,gy,dbh,{column}', *rows, ''])
    scene = open_scene(written(tmp_path, text), warn=False)
    assert [each.name for each in scene.trees] == kept
    assert any("1 dead or gone; line 3: status is 'D'" in each for each in scene.notes) == (
        len(kept) == 2
    )


@pytest.mark.parametrize('cells', [('TRUE', 'FALSE'), ('1', '0'), ('yes', 'no')])
def test_a_tree_that_is_not_alive_is_left_out(tmp_path: Path, cells: tuple[str, str]) -> None:
    rows = [f'{i},0,oak,30,{each}' for i, each in enumerate((*cells, cells[0]))]
    text = '\n'.join(['x,y,species,dbh [cm],CodeAlive', *rows, ''])
    scene = open_scene(written(tmp_path, text), warn=False)
    assert [each.name for each in scene.trees] == ['tree1', 'tree3']
    assert any(
        f"1 dead or gone; line 3: CodeAlive is '{cells[1]}'" in each for each in scene.notes
    )


@pytest.mark.parametrize(
    ('head', 'row', 'what'),
    [
        ('time,wind speed [m/s],wind direction [deg]', '{},5,270', 'wind'),
        ('time,ax,ay,az', '{},0.1,0.2,9.8', 'motion'),
    ],
)
def test_a_table_over_time_is_named_where_a_tree_is_expected(
    tmp_path: Path, head: str, row: str, what: str
) -> None:
    table = written(tmp_path, '\n'.join([head, *(row.format(i) for i in range(5)), '']))
    for opened in (open_tree, open_scene):
        with pytest.raises(FormatError, match=f': a record of {what}, not a tree'):
            opened(table)


def test_a_motion_that_was_simulated_is_no_tree(tmp_path: Path) -> None:
    table = tmp_path / 'sway.csv'
    seedling = str(HERE / 'data' / 'seedling.yaml')
    assert main(['simulate', seedling, '--seconds', '1', '-o', str(table)]) == 0
    for opened in (open_tree, open_scene):
        with pytest.raises(FormatError, match='table that `tree-sway simulate` wrote, not a tree'):
            opened(table)


@pytest.mark.parametrize('head', ['species,age', 'id;dbh'])
def test_a_table_of_trees_is_told_what_an_inventory_needs_first(tmp_path: Path, head: str) -> None:
    row = '1,2' if ',' in head else '1;2'
    with pytest.raises(FormatError) as found:
        open_tree(written(tmp_path, f'{head}\n{row}\n'))
    assert found.value.cure.startswith('an inventory has columns for the place')
    with pytest.raises(FormatError, match=': a file of an unknown tree format; give one of'):
        open_tree(written(tmp_path, 'hue,saturation\n1,2\n'))


@pytest.mark.parametrize('settings', [0, 100])
def test_a_geneactiv(tmp_path: Path, settings: int) -> None:
    above = 'Device Type,GENEActiv\n' + '\n' * (settings - 1) if settings else ''
    stamps = [f'2015-06-22 14:50:{20 + i // 50}:{20 * (i % 50):03d}' for i in range(100)]
    rows = [f'{each},0.0100,-0.5000,0.8660,12,0,25.8\n' for each in stamps]
    record = read_motion(written(tmp_path, above + ''.join(rows)))
    np.testing.assert_allclose(np.diff(record.time), 0.02, atol=1e-6)
    np.testing.assert_allclose(record.acceleration[5], np.multiply(G, (0.01, -0.5, 0.866)))


class Frame:
    """A table of pandas, of which a path is expected."""

    def to_csv(self) -> None: ...


@pytest.mark.parametrize(
    ('read', 'given', 'told'),
    [
        (open_tree, None, r'a NoneType, where the path of a file is expected; give its name, as'),
        (open_scene, 3, 'a int, where the path'),
        (read_wind, Frame(), r"a Frame, where .* first: frame.to_csv\('table.csv', index=False\)"),
        (read_motion, Frame(), r'frame.to_csv'),
    ],
)
def test_what_is_no_path_is_named(read: Callable[[Any], Any], given: Any, told: str) -> None:
    with pytest.raises(ParameterError, match=told):
        read(given)


def test_rows_that_repeat_a_tree_are_told(tmp_path: Path) -> None:
    rows = 'x,y,species,dbh\n0,0,oak,30\n0,0,oak,30\n0,0,oak,31\n9,0,oak,30\n'
    notes = ' '.join(open_scene(written(tmp_path, rows), warn=False).notes)
    assert '1 trees have the place, species and size of another, as line 2 and line 3' in notes
    one_each = rows.replace('0,0,oak,30\n0,0,oak,30', '0,0,oak,30\n0,5,oak,30')
    assert 'of another' not in ' '.join(open_scene(written(tmp_path, one_each), warn=False).notes)


@pytest.mark.parametrize('speed', ['0', '41'])
def test_a_speed_out_of_range_is_named_as_it_is_typed(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], speed: str
) -> None:
    output = str(tmp_path / 'sway.csv')
    assert main(['simulate', 'benjamina', '--speed', speed, '-o', output]) != 0
    assert f'--speed: {float(speed)} is out of range' in capsys.readouterr().err
