# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Stands from tables and from YAML, and what is wrong with others, by line."""

from __future__ import annotations

from pathlib import Path
import subprocess
import sys

import numpy as np
import pytest

from tree_sway.errors import FormatError, ParameterError, TreeSwayError
from tree_sway.files import text_file
from tree_sway.files.scenes.stand_table import read_stand_table
from tree_sway.files.trees.source import open_scene, open_tree

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
    assert stand.kind_numbers.tolist() == [0, 0, 1]
    assert [kind.species.key for kind in stand.kinds] == ['goldcrest', 'benjamina']
    heights = [tree.placed().height for tree in stand.trees]
    assert heights == pytest.approx([1.1, 0.9, 1.5])
    assert [tree.x for tree in stand.trees] == [1.0, 4.0, 8.0]
    assert len({tree.yaw for tree in stand.trees}) == 3
    again = open_scene(path).trees
    assert [(t.name, t.scale, t.yaw) for t in again] == [
        (t.name, t.scale, t.yaw) for t in stand.trees
    ]


def test_further_columns_are_read(tmp_path):
    path = written(
        tmp_path,
        'name,x,y,z,yaw,species,height,model\n'
        'a,0,0,0.5,1.5,goldcrest,1,0\nb,3,0,0,0,goldcrest,1,full\n',
    )
    a, b = read_stand_table(path).trees
    assert (a.name, a.z, a.yaw, a.model) == ('a', 0.5, 1.5, 0)
    assert (b.name, b.model) == ('b', 'full')


def test_trees_of_very_different_height_are_of_two_kinds(tmp_path):
    rows = ''.join(f'{i},0,goldcrest,{h}\n' for i, h in enumerate((1.0, 1.1, 1.2, 3.4)))
    stand = read_stand_table(written(tmp_path, 'x,y,species,height\n' + rows))
    assert len(stand.kinds) == 2
    assert all(0.7 < tree.scale < 1.45 for tree in stand.trees)


@pytest.mark.parametrize(
    ('rows', 'message'),
    [
        ('', 'no rows|header and rows|no row'),
        ('5,nan,oak,12\n', r"1 no place; line 2: y is 'nan', no place"),
        ('5,inf,oak,12\n', r"1 no place; line 2: y is 'inf', no place"),
        ('0,0,oak,ten\n', r"1 no height and no stem; line 2: height is 'ten'"),
        ('0,0,oak,0\n', r"line 2: height is '0'"),
        ('0,0,oak,-4\n', r'line 2: a height of -4 m'),
        ('0,0,oak,900\n', r'1 too high; line 2: height is 900, a height of 900 m; give its unit'),
        ('0,0\n', r'1 no height and no stem; line 2: '),
    ],
)
def test_a_table_without_a_good_row_is_refused_by_its_first_line(tmp_path, rows, message):
    path = written(tmp_path, 'x,y,species,height\n' + rows)
    with pytest.raises(TreeSwayError, match=message):
        read_stand_table(path)


def test_an_unknown_model_is_refused(tmp_path):
    path = written(tmp_path, 'x,y,species,height,model\n0,0,oak,10,best\n')
    with pytest.raises(ParameterError, match=r":2: unknown model 'best'.*full"):
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
    assert (stand.name, stand.convection_ratio, stand.anemometer) == ('hall', 1.3, (0, 0, 2))
    assert [kind.tree.name for kind in stand.kinds] == ['benjamina']
    assert stand.tree.n_segments == 2 * stand.kinds[0].tree.n_segments
    assert "'fig' is not in the table" in read_stand_table(tmp_path / 'plot.csv').notes[0]


@pytest.mark.parametrize(
    ('text', 'message'),
    [
        ('stand: nowhere.csv\n', 'nowhere.csv'),
        ('stand: plot.csv\ntrees_: 3\n', 'trees_'),
        ('stand: plot.csv\nkinds:\n  - {species: fig, tree: nothing}\n', r':3.*nothing'),
        ('stand: plot.csv\nconvection_ratio: -1\n', 'convection_ratio'),
    ],
)
def test_bad_yaml_is_refused(tmp_path, text, message):
    written(tmp_path, 'x,y,species,height\n0,0,goldcrest,1.6\n')
    with pytest.raises(TreeSwayError, match=message):
        open_scene(written(tmp_path, text, 'bad.yaml'))


def test_the_stand_of_the_package_has_a_thousand_trees():
    stand = open_scene(CONFIG / 'stand.yaml')
    assert len(stand.trees) == 1000
    assert len(stand.kinds) == 4


def test_a_column_that_is_not_used_is_named(tmp_path):
    path = written(tmp_path, 'x,y,species,height,owner\n0,0,oak,10,A\n9,0,oak,10,B\n')
    assert open_scene(path).notes == ('height is taken as m', 'columns that are not used: owner')


def test_grown_trees_have_roots_of_their_size(tmp_path):
    path = written(tmp_path, 'x,y,species,height\n0,0,oak,10\n9,0,goldcrest,1\n')
    oak, potted = open_scene(path).trees
    assert 1e4 < oak.species.root_stiffness < 1e8
    assert np.isinf(potted.species.root_stiffness)


def breast_diameter(placed):
    tree = placed.placed()
    stem = tree.segments_of(0)
    return float(np.interp(1.3, tree.start[stem][:, 2], tree.base_diameter[stem]))


def test_the_diameter_at_breast_height_counts(tmp_path):
    rows = '0,0,Quercus robur,18,15\n9,0,Quercus robur,18,60\n20,0,Quercus robur,18,62\n'
    thin, thick, alike = open_scene(written(tmp_path, 'x,y,species,height,dbh\n' + rows)).trees
    assert breast_diameter(thick) == pytest.approx(0.61, rel=0.02)
    assert breast_diameter(thin) < 0.3 * breast_diameter(thick)
    assert thick.tree is alike.tree
    assert [each.placed().height for each in (thin, thick)] == pytest.approx([18.0, 18.0])


@pytest.mark.parametrize(
    ('text', 'expected'),
    [
        # A national forest inventory, in UTM, diameters in mm.
        ('tree_id,utm_x,utm_y,species_name,dbh_mm,height_m\n7,500010,4000020,Pinus sylvestris,'
         '300,20\n8,500015,4000020,Pinus sylvestris,310,20\n', ('pine', 20.0, 0.305, 5.0)),
        # A city's list of trees: degrees, girth, German names, decimal commas.
        ('Baumnummer;Latitude;Longitude;Baumart;Umfang [cm];Hoehe\n1;52,5;13,4;Linde;94,2;15,5\n'
         '2;52,5;13,4001;Linde;94,2;15,5\n', ('lime', 15.5, 0.3, 6.77)),
        # A plot with diameters in metres and abbreviations.
        ('x\ty\tspp\th\td\n0\t0\tNS\t12\t0.2\n4\t0\tNS\t12\t0.2\n', ('spruce', 12.0, 0.2, 4.0)),
        # Imperial units.
        ('x,y,species,height (ft),dbh (in)\n0,0,Norway maple,49.2,12\n10,0,ACER,49.2,12\n',
         ('maple', 15.0, 0.305, 10.0)),
    ],
    ids=['inventory', 'city', 'plot', 'imperial'],
)  # fmt: skip
def test_inventories_of_others_are_read_as_they_are(tmp_path, text, expected):
    stand = open_scene(written(tmp_path, text))
    first, second = stand.trees
    key, height, diameter, apart = expected
    assert first.species.key == key
    assert first.placed().height == pytest.approx(height, rel=0.001)
    assert breast_diameter(first) == pytest.approx(diameter, rel=0.03)
    assert np.hypot(second.x - first.x, second.y - first.y) == pytest.approx(apart, rel=0.01)
    assert max(abs(second.x), abs(second.y)) < 100.0


def test_a_species_of_no_table_and_a_stem_that_would_not_stand_are_notes(tmp_path):
    rows = '0,0,Xyloma ignota,15,30\n9,0,western redcedar,20,3\n'
    stand = open_scene(written(tmp_path, 'x,y,species,height,dbh\n' + rows))
    assert [each.species.key for each in stand.trees] == ['broadleaf', 'conifer']
    notes = '; '.join(stand.notes)
    assert "'Xyloma ignota' is not in the table" in notes
    assert 'dbh is taken as cm' in notes
    assert 'as others would buckle' in notes


MANY = r"""
import re, sys
from tree_sway.files.trees.source import open_scene, open_tree
from tree_sway.core.scene.placed_tree import MOST_SEGMENTS
scene = open_scene(sys.argv[1])
assert len(scene.trees) == 30_000 and len(scene.kinds) <= 8
sizes = sum(each.tree.n_segments for each in scene.trees)
try:
    scene.tree
except Exception as error:
    assert sizes > MOST_SEGMENTS and 'segments in one record' in str(error)
print(re.search(r'VmHWM:\s+(\d+)', open('/proc/self/status').read())[1])
"""


def test_thirty_thousand_trees_take_the_memory_of_their_kinds(tmp_path):
    rows = [f'{6.0 * (i % 200)},{6.0 * (i // 200)},oak,{8 + i % 9}' for i in range(30_000)]
    path = written(tmp_path, 'x,y,species,height\n' + '\n'.join(rows) + '\n')
    command = [sys.executable, '-c', MANY, str(path)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 0, done.stderr
    assert int(done.stdout) < 400_000  # [KiB]; a tree of its own for each took 2.5 GiB


@pytest.mark.parametrize('name', ['seedling.yaml', 'forest.treefile.txt', 'stand'])
def test_the_head_of_a_file_is_read_once(tmp_path, monkeypatch, name):
    heads, read = [], text_file.read_bytes
    path = Path(__file__).parents[1] / 'data' / name
    if name == 'stand':
        path = written(tmp_path, 'x,y,species,height\n0,0,goldcrest,1\n3,0,goldcrest,1\n')

    def counted(which, at_most=None, **how):
        if at_most is not None and at_most <= 4096:
            heads.append(which)
        return read(which, **({} if at_most is None else {'at_most': at_most}), **how)

    monkeypatch.setattr(text_file, 'read_bytes', counted)
    open_scene(path)
    assert heads == [path]


def test_a_table_without_a_size_is_refused_by_its_columns(tmp_path):
    written(tmp_path, 'x,y,species\n0,0,oak\n3,0,oak\n')
    stand = written(tmp_path, 'stand: plot.csv\n', 'stand.yaml')
    with pytest.raises(
        FormatError,
        match=r'plot\.csv:1: no column for the size .height, dbh or girth. among x, y, spec',
    ):
        open_scene(stand)


@pytest.mark.parametrize(
    ('header', 'row', 'missing'),
    [
        ('x,y,species', '0,0,oak', r'the size \(height, dbh or girth\) among x, y, species'),
        ('species,height', 'oak,12', 'the place'),
        ('species,girth of it', 'oak,12', 'the place .* and none for the size'),
    ],
)
def test_a_column_that_an_inventory_lacks_is_named(tmp_path, header, row, missing):
    path = written(tmp_path, f'{header}\n{row}\n{row}\n')
    with pytest.raises(FormatError, match=f'no column for {missing}'):
        open_scene(path)


def test_the_names_of_two_more_inventories(tmp_path):
    path = written(tmp_path, 'x_m,y_m,species_latin,dbh_mm\n0,0,Quercus robur,300\n')
    assert open_scene(path).trees[0].species.key == 'oak'
    path = written(tmp_path, '@lat;@lon;species;Baumhöhe [m]\n48,8;2,3;oak;12,5\n')
    assert open_scene(path).trees[0].placed().height == pytest.approx(12.5)


@pytest.mark.parametrize('form', ['table', 'yaml'])
def test_an_inventory_where_one_tree_is_expected_says_what_to_do(tmp_path, form):
    path = written(tmp_path, 'x,y,species,height\n0,0,oak,12\n')
    if form == 'yaml':
        path = written(tmp_path, 'stand: plot.csv\n', 'stand.yaml')
    with pytest.raises(FormatError, match='where one tree is expected; make one of them, such as'):
        open_tree(path)
