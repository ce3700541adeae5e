# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The commands that write files: plot, grow, convert."""

from __future__ import annotations

from collections.abc import Callable
import json
from pathlib import Path

import numpy as np
import pytest

from tree_sway.commands import cli
from tree_sway.files.trees.source import open_tree

PNG = b'\x89PNG\r\n\x1a\n'
SEEDLING = str(Path(__file__).parents[2] / 'files' / 'data' / 'seedling.yaml')


@pytest.fixture
def wind_file(tmp_path: Path) -> Path:
    """Six seconds of a wind that freshens from the west."""
    path = tmp_path / 'wind.csv'
    rows = [f'{0.1 * k:.1f},{3 + 0.05 * k:.2f},0.5,0' for k in range(60)]
    path.write_text('\n'.join(['time,u,v,w', *rows]) + '\n')
    return path


def test_plot_draws_wind_and_tip(
    tmp_path: Path, wind_file: Path, capsys: pytest.CaptureFixture[str],
    installed: Callable[..., None],
) -> None:  # fmt: skip
    installed('plot')
    picture = tmp_path / 'sway.png'
    assert cli.main(['plot', 'goldcrest', '--wind', str(wind_file), '-o', str(picture)]) == 0
    assert picture.read_bytes().startswith(PNG)
    assert capsys.readouterr().out == f'{picture}\n'


@pytest.mark.parametrize(('leaves', 'season'), [([], 'in leaf'), (['--leaves', 'off'], 'bare')])
def test_a_plot_of_motion_says_the_season_and_how_much_of_the_record_it_shows(
    tmp_path, wind_file, installed, leaves, season
):
    installed('plot')
    picture = tmp_path / 'sway.svg'
    words = ['plot', SEEDLING, '--wind', str(wind_file), '--seconds', '2', *leaves]
    assert cli.main([*words, '-o', str(picture)]) == 0
    title = f'seedling, {season}, model 60, {wind_file.name}, 2 of 6 s'
    assert f'<!-- {title} -->' in picture.read_text(encoding='utf-8')


@pytest.mark.parametrize('arguments', [['goldcrest', '--portrait'], ['--portrait', SEEDLING]])
def test_plot_tree_draws_the_tree(
    tmp_path: Path, arguments: list[str], monkeypatch: pytest.MonkeyPatch,
    installed: Callable[..., None],
) -> None:  # fmt: skip
    installed('plot')
    monkeypatch.setattr('tree_sway.pictures.commands.plot._SETTLING', 2.0)
    picture = tmp_path / 'tree.png'
    assert cli.main(['plot', *arguments, '--leaves', 'on', '-o', str(picture)]) == 0
    assert picture.read_bytes().startswith(PNG)


def test_plot_refuses_a_wind_too_short_to_draw(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], installed: Callable[..., None]
) -> None:
    installed('plot')
    path = tmp_path / 'wind.csv'
    path.write_text('time,u,v,w\n0,1,0,0\n0.01,1,0,0\n')
    arguments = ['plot', SEEDLING, '--wind', str(path), '-o', str(tmp_path / 'x.png')]
    assert cli.main(arguments) == 2
    assert 'wind.csv: the wind is too short' in capsys.readouterr().err


@pytest.mark.parametrize('tree', [SEEDLING, 'nothing.yaml'])
def test_plot_refuses_a_format_it_cannot_draw_before_all_else(
    tmp_path: Path, wind_file: Path, capsys: pytest.CaptureFixture[str],
    installed: Callable[..., None], tree: str,
) -> None:  # fmt: skip
    installed('plot')
    arguments = ['plot', tree, '--wind', str(wind_file), '-o', str(tmp_path / 'x.doc')]
    assert cli.main(arguments) == 2
    assert "'.doc' is no picture format" in capsys.readouterr().err


@pytest.mark.parametrize(
    ('diameter', 'warning'),
    [('0.155', 'buckles in leaf'), pytest.param('0.4', '', marks=pytest.mark.long)],
)
def test_a_stem_that_its_crown_bends_over_is_said(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], diameter: str, warning: str
) -> None:
    size = ['--height', '15', '--diameter', diameter, '-o', str(tmp_path / 'willow.yaml')]
    assert cli.main(['grow', '--species', 'Salix alba', *size]) == 0
    printed = capsys.readouterr().err
    assert warning in printed
    assert bool(printed) == bool(warning)


@pytest.mark.parametrize('species', [('spruce',), ('--species', 'spruce')])
def test_a_grown_tree_is_as_high_as_asked_for(
    species: tuple[str, ...], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / 'spruce.yaml'
    command = ['grow', *species, '--height', '7', '--seed', '2', '-o', str(path)]
    assert cli.main(command) == 0
    assert 'spruce, ' in capsys.readouterr().out
    tree = open_tree(path).tree
    assert tree.height == pytest.approx(7.0)
    assert tree.species == 'spruce'


def test_a_tree_of_an_age_says_whose_stem_it_has(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / 'oak.yaml'
    assert cli.main(['grow', 'oak', '--height', '14', '--age', '50', '-o', str(path)]) == 0
    note = 'note: a stem of 0.48 m, as Quercus rubra along streets (Northeast, USA)'
    assert note in capsys.readouterr().err
    other = ['-o', str(tmp_path / 'larch.yaml')]
    assert cli.main(['grow', 'larch', '--height', '14', '--age', '50', *other]) == 2
    assert "no curve of growth for 'larch'" in capsys.readouterr().err


def test_converting_keeps_the_tree(tmp_path: Path) -> None:
    first, second = tmp_path / 'a.yaml', tmp_path / 'b.yaml'
    assert cli.main(['convert', 'goldcrest', '--density', '777', '-o', str(first)]) == 0
    assert cli.main(['convert', str(first), '-o', str(second)]) == 0
    built_in, again = open_tree('goldcrest'), open_tree(second)
    for name in ('start', 'end', 'base_diameter', 'tip_diameter', 'segment_parent'):
        assert np.array_equal(getattr(again.tree, name), getattr(built_in.tree, name)), name
    assert again.species.density == 777.0


def test_a_folder_that_is_not_there_is_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(['convert', 'goldcrest', '-o', '/no/such/folder/x.yaml']) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert '/no/such/folder/x.yaml' in line


def test_a_tree_that_sways_by_a_skin_or_by_weights(tmp_path: Path) -> None:
    for way in ('skin', 'morph', 'floats'):
        path = tmp_path / f'{way}.glb'
        arguments = ['convert', SEEDLING, '--leaves', 'on', '--sway', way, '-o', str(path)]
        assert cli.main(arguments) == 0
        assert path.read_bytes().startswith(b'glTF')
        assert (b'"skins"' in path.read_bytes()) == (way == 'skin')
        assert (b'"targetNames"' in path.read_bytes()) == (way != 'skin')
        assert (b'"animations"' in path.read_bytes()) == (way != 'skin')
        # Godot 4.6 refuses a file that requires an extension which it does not know.
        assert (b'"extensionsRequired"' in path.read_bytes()) == (way == 'morph')
        assert b'"leaves"' in path.read_bytes()


def test_a_tree_as_glb_is_in_leaf_and_sways_unless_told_otherwise(tmp_path: Path) -> None:
    path = tmp_path / 'tree.glb'
    assert cli.main(['convert', SEEDLING, '-o', str(path)]) == 0
    content = path.read_bytes()
    assert all(word in content for word in (b'"animations"', b'"leaves"', b'\x89PNG'))
    assert cli.main(['convert', SEEDLING, '--leaves', 'off', '--force', '-o', str(path)]) == 0
    assert b'"leaves"' not in path.read_bytes()


@pytest.mark.parametrize(
    ('suffix', 'start'), [('.usda', '#usda 1.0'), ('.xml', '<mujoco'), ('.sdf', '<sdf')]
)
def test_a_tree_for_another_program(tmp_path: Path, suffix: str, start: str) -> None:
    path = tmp_path / f'tree{suffix}'
    assert cli.main(['convert', SEEDLING, '-o', str(path)]) == 0
    assert path.read_text().startswith(start)


@pytest.mark.parametrize(
    ('arguments', 'message'),
    [
        ([SEEDLING, '-o', 'tree.yaml', '--sway'], "--sway: 'tree.yaml' cannot sway; write a .glb"),
        (['FOREST', '-o', 'trees.glb', '--sway', 'morph'], 'trees.glb: 2 trees, where one'),
        (['FOREST', '-o', 'trees.usda'], 'trees.usda: 2 trees, where one is expected; convert'),
        (['FOREST', '-o', 'trees.npz'], 'trees.npz: 2 trees, where one is expected; convert'),
    ],
)
def test_what_cannot_sway(
    tmp_path: Path, arguments: list[str], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    forest = tmp_path / 'forest.yaml'
    two = ', '.join(f'{{name: {name}, tree: {SEEDLING}}}' for name in 'ab')
    forest.write_text(f'trees: [{two}]\n')
    given = [str(forest) if word == 'FOREST' else word for word in arguments]
    assert cli.main(['convert', *given]) == 2
    assert message in capsys.readouterr().err


def test_a_simulated_tree_is_a_table_with_units(
    tmp_path: Path, wind_file: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    tables = [tmp_path / f'sway{suffix}' for suffix in ('.csv', '.json')]
    for path in tables:
        wind = ['--wind', str(wind_file), '--branch', 'stem', '--seconds', '2']
        assert cli.main(['simulate', SEEDLING, *wind, '-o', str(path)]) == 0
    text = capsys.readouterr().out
    assert text.startswith(f'{tables[0]}: SwayRecord of seedling')
    assert 'strength used: wood ' in text
    head, *rows = tables[0].read_text().splitlines()
    assert head.split(',')[:2] == ['time [s]', 'wind_x [m/s]']
    assert 'stem tip_x [m]' in head
    assert len(rows) == 120
    columns = json.loads(tables[1].read_text())
    assert [float(row.split(',')[-1]) for row in rows] == columns['stem largest strain [-]']


@pytest.mark.parametrize(
    ('arguments', 'message'),
    [
        (['-o', 'x.xls'], "'.xls' is no table; end it with one of: .csv, .parquet, .json"),
        (['--branch', 'stam', '-o', 'x.csv'], "no branch 'stam'; did you mean 'stem'?"),
    ],
)
def test_what_cannot_be_simulated(
    arguments: list[str], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert cli.main(['simulate', SEEDLING, *arguments]) == 2
    assert message in capsys.readouterr().err


def test_what_was_made_of_a_station_is_said(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / 'station.csv'
    rows = [f'{60 * k},{4 + k % 3},270,{8 + k % 3}' for k in range(6)]
    path.write_text('\n'.join(['time,speed,direction,gust', *rows, '400,x,270,8']))
    arguments = ['simulate', SEEDLING, '--wind', str(path), '--seconds', '1']
    assert cli.main([*arguments, '-o', str(tmp_path / 'sway.csv')]) == 0
    notes = capsys.readouterr().err
    assert 'turbulence is simulated about them by their gusts, seed 0' in notes
    assert "1 rows refused; line 8: speed is 'x'" in notes


@pytest.mark.parametrize('command', ['simulate', 'convert', 'plot', 'render', 'grow', 'calibrate'])
def test_where_nothing_can_be_written_is_said_before_any_work(
    command, tmp_path, capsys, installed
):
    installed(command)
    suffix = {'simulate': '.csv', 'plot': '.png', 'render': '.gif'}.get(command, '.yaml')
    path = tmp_path / 'nowhere' / f'out{suffix}'
    needed = {'grow': ['--height', '3'], 'calibrate': ['--frequency', '3']}.get(command, [])
    assert cli.main([command, 'no such tree', *needed, '-o', str(path)]) == 2
    assert 'cannot be written: no such folder; give an existing' in capsys.readouterr().err


def test_a_name_without_a_suffix_is_called_so(tmp_path, capsys):
    assert cli.main(['convert', 'goldcrest', '-o', str(tmp_path / 'tree')]) == 2
    assert 'a name without a suffix; use .yaml' in capsys.readouterr().err


def test_the_speed_of_a_wind_is_that_of_the_animation(tmp_path: Path) -> None:
    moved = []
    for speed in ([], ['--speed', '6'], ['--speed', '12']):
        glb, usda = (tmp_path / f'{len(moved)}{suffix}' for suffix in ('.glb', '.usda'))
        for path in (glb, usda):
            assert cli.main(['convert', SEEDLING, *speed, '-o', str(path)]) == 0
        moved.append((glb.read_bytes(), usda.read_text().partition('def Scope')[0]))
    assert moved[0] == moved[1]
    assert moved[0][0] != moved[2][0]
    assert moved[0][1] != moved[2][1]


@pytest.mark.parametrize(
    ('arguments', 'told'),
    [
        (['-o', 'a.glb'], 'leaves on, 20 s of wind'),
        (['-o', 'a.usdz', '--leaves', 'off'], 'leaves off, 10 s of wind'),
        (['-o', 'a.glb', '--sway', 'skin'], 'leaves on'),
        (['-o', 'a.yaml'], ''),
    ],
)
def test_what_is_in_a_file_is_told_in_a_line(
    arguments: list[str], told: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    monkeypatch.chdir(tmp_path)
    assert cli.main(['convert', SEEDLING, *arguments]) == 0
    (line,) = capsys.readouterr().out.splitlines()
    size = f'{Path(arguments[1]).stat().st_size / 1e6:.2g} MB'
    assert line.endswith('; ' + ', '.join(filter(None, (size, told))))
