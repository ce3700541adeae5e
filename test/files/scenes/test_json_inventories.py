# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Lists of trees in documents of JSON, wherever they are: none is cut to its first record."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from tree_sway.errors import FormatError
from tree_sway.files.scenes.inventory.inventory_file import inventory_table
from tree_sway.files.scenes.inventory.read_inventory import Inventory, inventory_of
from tree_sway.files.text_file import read_head


def read(folder: Path, document: Any) -> Inventory:
    path = folder / 'trees.json'
    path.write_text(json.dumps(document), encoding='utf-8')
    return inventory_of(inventory_table(path, read_head(path)))


def tree(number: int, **further: Any) -> dict[str, Any]:
    return {
        'id': f'T{number}',
        'species': 'Acer campestre',
        'lat': 48.0 + number * 1e-4,
        'lon': 9.0,
        'height': 10.0 + number,
        **further,
    }


TREES = [*map(tree, range(5))]
NAMES = tuple(each['id'] for each in TREES)
BY_KEY = {f'-N{number}x': each for number, each in enumerate(TREES)}
ATTRIBUTES = [{'type': 'trees', 'attributes': each} for each in TREES]
COLUMNS = {name: [each[name] for each in TREES] for name in TREES[0]}
DOCUMENTS = {
    'hal': {'_links': {'next': {'href': 'x'}}, '_embedded': {'trees': TREES}, 'page': {'size': 5}},
    'pages': [{'_embedded': {'trees': TREES[:2]}}, {'_embedded': {'trees': TREES[2:]}}],
    'json_api': {'data': ATTRIBUTES, 'meta': {'count': 5}},
    'graphql': {'data': {'trees': {'edges': [{'node': each} for each in TREES]}}},
    'streets': [{'street': 'A', 'trees': TREES[:1]}, {'street': 'B', 'trees': TREES[1:]}],
    'results_of_streets': {'results': [{'trees': TREES[:2]}, {'trees': TREES[2:]}]},
    'an_empty_list_beside': {'records': [], 'items': TREES},
    'two_lists': {'oaks': TREES[:3], 'maples': TREES[3:]},
    'by_key': BY_KEY,
    'by_key_in_a_name': {'trees': BY_KEY},
    'by_key_in_districts': {'a': dict([*BY_KEY.items()][:2]), 'b': dict([*BY_KEY.items()][2:])},
    'columns': COLUMNS,
    'pandas': {
        name: {str(row): each for row, each in enumerate(COLUMNS[name])} for name in COLUMNS
    },
}


@pytest.mark.parametrize('name', DOCUMENTS)
def test_every_tree_is_read(tmp_path: Path, name: str) -> None:
    trees = read(tmp_path, DOCUMENTS[name])
    assert trees.names == NAMES
    assert trees.height.tolist() == [10.0, 11.0, 12.0, 13.0, 14.0]
    assert 11.0 < trees.y[1] - trees.y[0] < 11.2
    assert {*trees.species} == {'Acer campestre'}


def test_records_that_lack_a_name_are_counted(tmp_path: Path) -> None:
    without = {key: value for key, value in tree(7).items() if key != 'height'}
    trees = read(tmp_path, {'_embedded': {'trees': [*TREES, without]}})
    assert trees.names == NAMES
    left_out = '1 row is left out: 1 no height and no stem; feature 6'
    assert any(note.startswith(left_out) for note in trees.notes)


def test_one_tree_may_be_the_document(tmp_path: Path) -> None:
    assert read(tmp_path, tree(3)).names == ('T3',)
    assert read(tmp_path, {'tree': tree(3), 'page': {'size': 1}}).names == ('T3',)


def test_stems_of_a_tree_are_no_trees_and_the_first_is_said(tmp_path: Path) -> None:
    trees = read(tmp_path, [tree(each, stems=[{'dbh': 30}, {'dbh': 20}]) for each in range(3)])
    assert trees.diameter.tolist() == [0.3, 0.3, 0.3]
    assert 'some trees have several of stems.dbh: the first of each counts' in trees.notes


def test_tags_that_are_not_of_openstreetmap_leave_no_tree_out(tmp_path: Path) -> None:
    trees = read(tmp_path, {'trees': [tree(0, tags=['a', 'b', 'c']), tree(1), tree(2, tags=[])]})
    assert trees.names == ('T0', 'T1', 'T2')


def test_rows_without_names_are_refused(tmp_path: Path) -> None:
    with pytest.raises(FormatError):
        read(tmp_path, [[*COLUMNS], *([*each.values()] for each in TREES)])


def test_stems_of_a_tree_are_no_trees(tmp_path: Path) -> None:
    tree = {'species': 'Quercus robur', 'lat': 50.0, 'lon': 8.0, 'height': 12}
    stems = [{'species': 'Quercus robur', 'dbh': dbh} for dbh in (30, 20)]
    trees = read(tmp_path, [{**tree, 'id': number, 'stems': stems} for number in range(3)])
    assert len(trees.names) == 3


def test_pages_in_metres_of_a_web_map_are_refused(tmp_path: Path) -> None:
    feature = {'attributes': {'species': 'oak', 'height': 9}, 'geometry': {'x': 1e6, 'y': 6e6}}
    page = {'spatialReference': {'wkid': 102100}, 'features': [feature]}
    with pytest.raises(FormatError, match='Web Mercator'):
        read(tmp_path, [page, page])
