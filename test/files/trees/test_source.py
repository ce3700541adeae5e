# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
from pathlib import Path

import pytest

from tree_sway.errors import FormatError
from tree_sway.files.trees.source import BUILTIN_TREES, open_tree

DATA = Path(__file__).parents[1] / 'data'


@pytest.mark.parametrize('name', BUILTIN_TREES)
def test_built_in_trees(name):
    tree_file = open_tree(name)
    assert tree_file.source == name
    assert tree_file.species.key == tree_file.tree.species


def test_files_by_path_in_any_form():
    for path in (DATA / 'seedling.yaml', str(DATA / 'seedling.yaml')):
        assert open_tree(path).tree.name == 'seedling'
    assert open_tree(DATA / 'segments.csv', species='oak').species.key == 'oak'


def test_a_file_of_a_built_in_name_is_meant_by_its_path(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / 'benjamina').write_bytes((DATA / 'seedling.yaml').read_bytes())
    assert open_tree('./benjamina').tree.name == 'seedling'
    assert open_tree('benjamina').source == 'benjamina'


def test_neither():
    with pytest.raises(FormatError, match="no tree 'benjamin'; did you mean 'benjamina'"):
        open_tree('benjamin')
    with pytest.raises(FormatError, match=r"no tree '\./none\.yaml'; give a file, or one of"):
        open_tree('./none.yaml')


def test_a_file_with_nearly_the_name_is_named(tmp_path):
    (tmp_path / 'willow.yaml').write_text('')
    with pytest.raises(FormatError, match=r"did you mean '.*willow\.yaml'"):
        open_tree(tmp_path / 'wilow.yaml')
