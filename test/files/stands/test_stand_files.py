# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Stands from tables and from YAML, and what is wrong with others, by line."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tree_sway_ros.errors import FormatError, SpeciesError, TreeSwayError
from tree_sway_ros.files.stands.stand_file import StandFile
from tree_sway_ros.files.stands.stand_table import read_stand_table
from tree_sway_ros.files.trees.source import open_scene

CONFIG = Path(__file__).parents[3] / 'config'


def written(folder, text, name='plot.csv'):
    path = folder / name
    path.write_text(text, encoding='utf-8')
    return path


def test_a_table_of_a_forester_is_a_stand(tmp_path):
    path = written(
        tmp_path,
        '# plot 7\nx;y;Species;height\n1;2;goldcrest;1.1\n4;2;goldcrest;0.9\n8;2;benjamina;1.5\n',
    )
    stand = open_scene(path)
    assert isinstance(stand, StandFile)
    assert [tree.kind for tree in stand.standing] == ['goldcrest 0.995 m'] * 2 + [
        'benjamina 1.5 m'
    ]
    simulator = stand.simulator(model='frozen')
    heights = [np.ptp(simulator.tree_of(t).end[:, 2]) for t in range(3)]
    assert heights == pytest.approx([1.1, 0.9, 1.5])
    assert [tree.x for tree in stand.standing] == [1.0, 4.0, 8.0]
    assert len({tree.yaw for tree in stand.standing}) == 3
    assert open_scene(path).standing == stand.standing


def test_further_columns_are_read(tmp_path):
    path = written(
        tmp_path,
        'name,x,y,z,yaw,species,height,fidelity\n'
        'a,0,0,0.5,1.5,goldcrest,1,frozen\nb,3,0,0,0,goldcrest,1,wind_basis\n',
    )
    a, b = read_stand_table(path).standing
    assert (a.name, a.z, a.yaw, a.fidelity) == ('a', 0.5, 1.5, 'frozen')
    assert (b.name, b.fidelity) == ('b', 'wind_basis')


def test_trees_of_very_different_height_are_of_two_kinds(tmp_path):
    rows = ''.join(f'{i},0,goldcrest,{h}\n' for i, h in enumerate((1.0, 1.1, 1.2, 3.4)))
    stand = read_stand_table(written(tmp_path, 'x,y,species,height\n' + rows))
    assert len(stand.kinds) == 2
    assert all(0.7 < tree.scale < 1.45 for tree in stand.standing)


@pytest.mark.parametrize(
    ('rows', 'told'),
    [
        ('', 'no rows|header and rows|no row'),
        ('0,0,oak,10\n5,0,oakk,12\n', r":3: unknown species 'oakk'.*oak"),
        ('0,0,oak,10\n5,nan,oak,12\n', r':3: .*y'),
        ('0,0,oak,10\n5,inf,oak,12\n', r':3: .*y'),
        ('0,0,oak,ten\n', r':2: .*height'),
        ('0,0,oak,0\n', r':2: a height of 0 m'),
        ('0,0,oak,-4\n', r':2: a height of -4 m'),
        ('0,0,oak,900\n', r':2: .*900'),
        ('0,0,,10\n', r':2: no species'),
        ('0,0\n', r':2: '),
    ],
)
def test_a_bad_row_is_refused_by_its_line(tmp_path, rows, told):
    path = written(tmp_path, 'x,y,species,height\n' + rows)
    with pytest.raises(TreeSwayError, match=told):
        read_stand_table(path)


def test_two_trees_of_one_name_are_refused(tmp_path):
    path = written(tmp_path, 'name,x,y,species,height\na,0,0,oak,10\nb,1,0,oak,9\na,5,0,oak,9\n')
    with pytest.raises(FormatError, match=r":4: two trees called 'a', the first in line 2"):
        read_stand_table(path)
    path = written(tmp_path, 'name,x,y,species,height\na/b,0,0,oak,10\n')
    with pytest.raises(FormatError, match='slash'):
        read_stand_table(path)


def test_an_unknown_fidelity_is_refused(tmp_path):
    path = written(tmp_path, 'x,y,species,height,fidelity\n0,0,oak,10,best\n')
    with pytest.raises(FormatError, match=r":2: unknown fidelity 'best'.*wind_basis"):
        read_stand_table(path)


def test_yaml_names_a_table_and_its_kinds(tmp_path):
    written(tmp_path, 'x,y,species,height\n0,0,fig,1.6\n2,0,fig,1.2\n')
    path = written(
        tmp_path,
        'name: hall\nstand: plot.csv\nconvection_ratio: 1.3\nanemometer: [0, 0, 2]\n'
        'kinds:\n  - {species: fig, tree: benjamina}\n',
        'hall.yaml',
    )
    stand = open_scene(path)
    assert isinstance(stand, StandFile)
    assert (stand.name, stand.convection_ratio, stand.anemometer) == ('hall', 1.3, (0, 0, 2))
    assert list(stand.kinds) == ['fig']
    assert stand.tree.n_segments == 2 * stand.kinds['fig'].tree.n_segments
    with pytest.raises(SpeciesError, match="unknown species 'fig'"):
        read_stand_table(tmp_path / 'plot.csv')


@pytest.mark.parametrize(
    ('text', 'told'),
    [
        ('stand: nowhere.csv\n', 'nowhere.csv'),
        ('stand: plot.csv\ntrees_: 3\n', 'trees_'),
        ('stand: plot.csv\nkinds:\n  - {species: fig, tree: nothing}\n', r':3.*nothing'),
        ('stand: plot.csv\nconvection_ratio: -1\n', 'convection_ratio'),
    ],
)
def test_bad_yaml_is_refused(tmp_path, text, told):
    written(tmp_path, 'x,y,species,height\n0,0,goldcrest,1.6\n')
    with pytest.raises(TreeSwayError, match=told):
        open_scene(written(tmp_path, text, 'bad.yaml'))


def test_the_stand_of_the_package_has_a_thousand_trees():
    stand = open_scene(CONFIG / 'stand.yaml')
    assert len(stand.standing) == 1000
    assert len(stand.kinds) == 4
