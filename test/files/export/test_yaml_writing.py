# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
from dataclasses import replace
from pathlib import Path

from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
import pytest

from tree_sway.core.species.species import species_named
from tree_sway.core.tree.building import tree_from_segments
from tree_sway.core.tree.tree import Tree
from tree_sway.errors import SpeciesError
from tree_sway.files.export.tree_export import write_tree
from tree_sway.files.export.yaml_writing import yaml_of_tree
from tree_sway.files.trees.yaml.tree_yaml import parse_yaml_tree, read_yaml_tree

DATA = Path(__file__).parents[1] / 'data'


def assert_same_tree(one: Tree, other: Tree) -> None:
    for key in vars(one):
        if key != 'source_index':
            np.testing.assert_array_equal(getattr(one, key), getattr(other, key), err_msg=key)


def random_tree(seed: int, n: int = 30, joined: bool = False) -> Tree:
    """Make a tree with gaps, steps in thickness and odd names."""
    rng = np.random.default_rng(seed)
    parent = np.array([-1, *(rng.integers(0, i) for i in range(1, n))])
    start, end = np.zeros((n, 3)), rng.normal(size=(n, 3))
    for i in range(1, n):
        start[i] = end[parent[i]] + (0.0 if joined else rng.normal(scale=0.01, size=3))
        end[i] += start[i]
    return tree_from_segments(
        start, end, rng.uniform(0.01, 0.1, (n, 2)), parent=parent, name="a: 'b'"
    )


@pytest.mark.parametrize('joined', [False, True])
@settings(deadline=None, max_examples=30)
@given(seed=st.integers(0, 2**32 - 1))
def test_reading_back_is_the_identity(joined, seed):
    tree = random_tree(seed, joined=joined)
    assert_same_tree(parse_yaml_tree(yaml_of_tree(tree)).tree, tree)


@settings(deadline=None, max_examples=30)
@given(
    name=st.text(min_size=1).filter(lambda text: not any(0xD800 <= ord(c) < 0xE000 for c in text))
)
def test_any_name_survives(name):
    tree = replace(random_tree(0, n=1), name=name, branch_names=(name,))
    back = parse_yaml_tree(yaml_of_tree(tree)).tree
    assert (back.name, back.branch_names) == (name, (name,))


def test_written_file_reads_back(tmp_path):
    first = read_yaml_tree(DATA / 'seedling.yaml')
    write_tree(tmp_path / 'again.yaml', first.tree, first.species)
    again = read_yaml_tree(tmp_path / 'again.yaml')
    assert_same_tree(again.tree, first.tree)
    assert again.species == first.species


def test_a_calibrated_tree_keeps_its_wood():
    tree = replace(random_tree(1), species='benjamina')
    table = species_named('benjamina')
    assert 'wood' not in yaml_of_tree(tree)
    for calibrated in (
        replace(table, modulus=7.123456789012345e9, is_estimate=False),
        replace(table, density=912.5, damping_bare=0.031, drag_exponent=0.7),
        replace(table, is_estimate=False),
    ):
        assert parse_yaml_tree(yaml_of_tree(tree, calibrated)).species == calibrated


def test_unknown_species_is_not_written():
    with pytest.raises(SpeciesError, match="unknown species 'baobab'"):
        yaml_of_tree(replace(random_tree(1), species='baobab'))
