# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Tables of research plots: names with one beginning, and several rows of each tree."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tree_sway.errors import FormatError
from tree_sway.files.scenes.inventory.inventory_file import inventory_table
from tree_sway.files.scenes.inventory.read_inventory import Inventory, inventory_of
from tree_sway.files.text_file import read_head
from tree_sway.files.trees.source import open_scene

SECTIONS = """"","tree_id","dbh","h","hi","di"
"1",1,31.2,22.4,0.1,37.8
"2",1,31.2,22.4,0.7,32.9
"3",1,31.2,22.4,1.3,31.2
"4",2,24.7,19.8,0.1,30.1
"5",2,24.7,19.8,0.7,26.1
"""


def read(folder: Path, text: str) -> Inventory:
    path = folder / 'trees.csv'
    path.write_text(text, encoding='utf-8')
    return inventory_of(inventory_table(path, read_head(path)), needs_place=False)


@pytest.mark.parametrize('prefix', ['pl_', 't_', 'GR_', 'bm_'])
def test_what_most_names_begin_with_is_none_of_them(tmp_path: Path, prefix: str) -> None:
    names = ['age', 'code', 'dbh', 'height', 'name', 'sens_hgt', 'species']
    head = ','.join([*(prefix + each for each in names), 'si_code'])
    rows = '90,Q1,17,10.9,PS01,1.3,Pinus sylvestris,ESP\nNA,Q2,22,NA,QP02,1.3,Quercus,ESP\n'
    trees = read(tmp_path, f'{head}\n{rows}')
    assert trees.names == ('PS01', 'QP02')
    assert trees.species == ('Pinus sylvestris', 'Quercus')
    assert trees.diameter.tolist() == [0.17, 0.22]
    assert trees.height[0] == 10.9
    with pytest.raises(FormatError, match='no column for the place'):
        open_scene(tmp_path / 'trees.csv')


def test_a_beginning_that_says_what_was_measured_is_kept(tmp_path: Path) -> None:
    text = 'crown_height,crown_width,crown_base,species,dbh\n6,5,4,oak,30\n7,5,4,oak,40\n'
    trees = read(tmp_path, text)
    assert trees.is_height_found == (True, True)
    assert trees.diameter.tolist() == [0.3, 0.4]


def test_sections_of_a_stem_are_one_tree(tmp_path: Path) -> None:
    trees = read(tmp_path, SECTIONS)
    assert trees.names == ('1', '2')
    assert trees.lines == (2, 5)
    assert trees.height.tolist() == [22.4, 19.8]
    assert any(note.startswith('3 rows are left out: 3 of a tree above') for note in trees.notes)


def test_rows_with_a_number_of_their_own_are_trees_of_one_place(tmp_path: Path) -> None:
    rows = [f'{row},S{row // 3},{row // 3},0,oak,3' for row in range(9)]
    trees = read(tmp_path, '\n'.join(['tree_id,site_id,x,y,species,height', *rows]) + '\n')
    assert len(trees.names) == 9


def test_trees_of_two_species_on_one_place_are_two(tmp_path: Path) -> None:
    rows = [f'{row},0,{species},10' for row in range(3) for species in ('oak', 'ash')]
    trees = read(tmp_path, '\n'.join(['number,y,species,height', *rows]) + '\n')
    assert len(trees.names) == 6


def test_numbers_that_begin_anew_are_other_trees(tmp_path: Path) -> None:
    rows = ['1,oak,10', '2,oak,12', '1,oak,10', '2,oak,14']
    trees = read(tmp_path, '\n'.join(['tree_no,species,height', *rows]) + '\n')
    assert trees.height.tolist() == [10.0, 12.0, 10.0, 14.0]
    assert any(note.startswith('2 names are changed') for note in trees.notes)


def test_the_diameter_of_all_stems_counts_before_that_of_one(tmp_path: Path) -> None:
    header = 'species,stem_diameter_1_cm,stem_diameter_2_cm,height_m,combined_stem_diameter_cm'
    trees = read(tmp_path, f'{header}\nbeech,30,40,16,50\noak,30,NA,15,30\n')
    np.testing.assert_allclose(trees.diameter, [0.5, 0.3])
