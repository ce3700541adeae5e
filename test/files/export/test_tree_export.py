# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tree_sway.errors import FormatError, SpeciesError
from tree_sway.files.export.tree_export import write_tree
from tree_sway.files.trees.tree_file import read_tree, read_trees

DATA = Path(__file__).parents[1] / 'data'
SOURCES = [
    *sorted(p.name for p in DATA.glob('fork.*')), 'forest.treefile.txt', 'seedling.yaml',
    'segments.csv',
]  # fmt: skip


@pytest.fixture
def tree():
    return read_tree(DATA / 'fork.archi.csv').tree


@pytest.mark.parametrize('name', SOURCES)
def test_import_export_import_is_the_identity(tmp_path, name):
    for number, first in enumerate(read_trees(DATA / name)):
        path = tmp_path / f'{number}.yaml'
        write_tree(path, first.tree, first.species)
        again = read_tree(path)
        assert again.species == first.species
        for key, value in vars(first.tree).items():
            if key != 'source_index':
                np.testing.assert_array_equal(getattr(again.tree, key), value, err_msg=key)


def test_errors(tmp_path, tree):
    with pytest.raises(FormatError, match=r"cannot write '.stl'; use .yaml, .yml, .glb"):
        write_tree(tmp_path / 'tree.stl', tree)
    with pytest.raises(FormatError, match='cannot be written: No such file'):
        write_tree(tmp_path / 'none' / 'tree.glb', tree)


def test_a_failure_keeps_the_file_that_was_there(tmp_path, tree):
    path = tmp_path / 'tree.yaml'
    path.write_text('mine')
    with pytest.raises(SpeciesError):
        write_tree(path, replace(tree, species='no such'))
    assert path.read_text() == 'mine'
