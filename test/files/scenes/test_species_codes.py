# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Species of inventories by the codes of FIA and of ICP Forests."""

from __future__ import annotations

from pathlib import Path

import pytest

from tree_sway.core.species.species import species_like
from tree_sway.files.scenes.inventory.inventory_file import inventory_table
from tree_sway.files.scenes.inventory.read_inventory import Inventory, inventory_of
from tree_sway.files.scenes.inventory.species_codes import FIA, ICP, name_of, names_of
from tree_sway.files.text_file import read_head

ICP_TREES = (
    'code_country;code_plot;tree;{species};dbh;height;x;y\n'
    '4;101;1;20;38,5;27,4;0;0\n'
    '4;101;2;118;31,0;25,1;4;3\n'
    '4;101;3;048;44,1;26,0;8;1\n'
)
FIA_TREES = (
    'PLOT,TREE,{species},DIA,HT_FT,LAT,LON\n'
    '7,1,802,14.2,72,38.9012,-80.1011\n'
    '7,2,316,9.8,61,38.9013,-80.1012\n'
    '7,3,12,8.1,48,38.9014,-80.1013\n'
)


def read(tmp_path: Path, text: str) -> Inventory:
    path = tmp_path / 'trees.csv'
    path.write_text(text, encoding='utf-8')
    return inventory_of(inventory_table(path, read_head(path)))


def keys(inventory: Inventory) -> list[str]:
    return [inventory.wood[name].key for name in inventory.species]


@pytest.mark.parametrize('column', ['code_tree_species', 'tree_species', 'tree_spec'])
def test_codes_of_icp_forests(tmp_path: Path, column: str) -> None:
    found = read(tmp_path, ICP_TREES.format(species=column))
    assert keys(found) == ['beech', 'spruce', 'oak']
    assert f'{column} is taken as codes of ICP Forests' in found.notes


@pytest.mark.parametrize('column', ['SPCD', 'fia_code', 'species'])
def test_codes_of_fia(tmp_path: Path, column: str) -> None:
    # Any name will do in the United States.
    found = read(tmp_path, FIA_TREES.format(species=column))
    assert keys(found) == ['oak', 'red_maple', 'fir']
    assert f'{column} is taken as codes of FIA' in found.notes
    assert found.diameter[0] == pytest.approx(14.2 * 0.0254)


def test_codes_of_an_unknown_list_are_said(tmp_path: Path) -> None:
    found = read(tmp_path, ICP_TREES.format(species='species'))
    assert keys(found) == ['broadleaf'] * 3
    assert any('name the column SPCD' in note for note in found.notes)


def test_codes_that_a_list_does_not_know_are_said(tmp_path: Path) -> None:
    text = ICP_TREES.format(species='code_tree_species').replace(';20;', ';777;')
    assert any('unknown list' in note for note in read(tmp_path, text).notes)
    many = ''.join(f'4;102;{k};20;30;25;{k};9\n' for k in range(20))
    found = read(tmp_path, text + many)
    assert keys(found)[:2] == ['broadleaf', 'spruce']
    assert any("'777' is not in the table" in note for note in found.notes)


def test_missing_codes_are_negative(tmp_path: Path) -> None:
    many = ''.join(f'4;102;{k};20;30;25;{k};9\n' for k in range(20))
    text = ICP_TREES.format(species='code_tree_species').replace(';20;', ';-9;') + many
    assert keys(read(tmp_path, text))[:2] == ['broadleaf', 'spruce']


@pytest.mark.parametrize(
    ('code', 'list_name', 'key'),
    [
        # Appendix of species codes, FIA field guide 9.1.
        ('131', FIA, 'pine'),
        ('202', FIA, 'douglas_fir'),
        ('98', FIA, 'sitka'),
        ('318', FIA, 'maple'),
        ('901', FIA, 'robinia'),
        ('81', FIA, 'conifer'),
        # Dictionary d_tree_spec of ICP Forests.
        ('100', ICP, 'fir'),
        ('134', ICP, 'pine'),
        ('116', ICP, 'larch'),
        ('22', ICP, 'ash'),
        ('13', ICP, 'hornbeam'),
        ('199', ICP, 'conifer'),
        ('99', ICP, 'broadleaf'),
    ],
)
def test_species_of_a_code(code: str, list_name: str, key: str) -> None:
    assert species_like(name_of(code, list_name))[0].key == key


def test_conifers_are_conifers() -> None:
    """In FIA's list conifers have the codes below 300."""
    for code, name in names_of(FIA).items():
        needles = species_like(name)[0].leaves.are_needles
        assert needles == (code < 300), f'{code} {name}'
