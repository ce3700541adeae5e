# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Formats of nodes: SWC, tree files, MTG."""

from pathlib import Path

import numpy as np
import pytest

from tree_sway.errors import FormatError, ParameterError, TreeError, TreeSwayError
from tree_sway.files.trees.tree_file import read_tree, read_trees

DATA = Path(__file__).parents[2] / 'data'


def test_swc_of_two_trees():
    fork, pole = read_trees(DATA / 'fork.swc')
    assert (fork.tree.n_segments, fork.tree.n_branches) == (4, 2)
    np.testing.assert_allclose(fork.tree.base_diameter, [0.24, 0.2, 0.2, 0.06])
    np.testing.assert_allclose(fork.tree.tip_diameter, [0.2, 0.16, 0.06, 0.04])
    np.testing.assert_allclose(fork.tree.end[3], [101.2, 200, 52.3], atol=1e-9)
    np.testing.assert_allclose(pole.tree.start[0], [110.0, 200.0, 50.0])
    assert pole.tree.height == 3.0


def test_swc_in_micrometres():
    small = read_tree(DATA / 'fork.swc', length_unit=1e-3, diameter_unit=1e-3).tree
    assert small.height == pytest.approx(2.3e-3)
    assert small.base_diameter[0] == pytest.approx(0.24e-3)
    with pytest.raises(ParameterError, match=r'length_unit: 0\.0 is out of range'):
        read_tree(DATA / 'fork.swc', length_unit=0.0)


def test_treefile_of_two_trees():
    fork, pole = read_trees(DATA / 'forest.treefile.txt', twig_diameter=0.0)
    assert (fork.tree.name, pole.tree.name) == ('forest.treefile1', 'forest.treefile2')
    assert (fork.tree.n_segments, fork.tree.n_branches) == (4, 2)
    volume = np.pi * (0.1**2 + 0.08**2 + 0.03**2 * np.sqrt(0.61) + 0.02**2)
    assert fork.tree.volume.sum() == pytest.approx(volume, rel=1e-9)
    # Two segments begin at the root: the thicker is the stem and carries the other.
    assert list(pole.tree.segment_parent) == [-1, 0]
    np.testing.assert_allclose(pole.tree.start[1], [0, 0, 0])


def test_mtg():
    tree_file = read_tree(DATA / 'fork.mtg', to_origin=True)
    tree = tree_file.tree
    assert (tree.n_segments, tree.n_branches) == (5, 3)
    assert tree_file.notes[0] == '10 vertices with a position, 2 without; 7 of them segments'
    assert tree_file.notes[1].startswith('2 cylinders of zero length were left out')
    assert tree.height == pytest.approx(2.3)
    np.testing.assert_allclose(tree.base_diameter[:2], [0.2, 0.18])
    np.testing.assert_allclose(tree.tip_diameter[:2], [0.18, 0.16])
    np.testing.assert_allclose(tree.start[2], [0, 0, 0.7], atol=1e-9)
    assert list(tree.segment_parent) == [-1, 0, 0, 2, 0]
    np.testing.assert_allclose(tree.end[4], [0.1, 0, 1.1], atol=1e-9)


def test_mtg_in_other_units():
    tree = read_tree(DATA / 'fork.mtg', length_unit=1.0, diameter_unit=0.1).tree
    assert tree.height == pytest.approx(230.0)
    assert tree.base_diameter[0] == pytest.approx(20.0)


@pytest.mark.parametrize(
    ('name', 'old', 'new', 'kind', 'message'),
    [
        ('fork.swc', '21 3', '20 3', FormatError, ':6: node 20: number 20 occurs twice'),
        ('fork.swc', '0.02 20', '0.02 99', TreeError, ':6: node 21: orphan: its parent 99'),
        ('fork.swc', '0.12 -1', '0.12 12', TreeError, 'cyclic'),
        ('fork.swc', '0.02 20', '0.02', FormatError, ":6: 6 cells, none for 'parent'"),
        ('forest.treefile.txt', ',parent_id', ',parent', FormatError, ':3: no field parent_id'),
        ('forest.treefile.txt', '0.02,2,2', '0.02,2', FormatError,
         ':4: 29 values are not whole nodes'),
        ('forest.treefile.txt', '0.02,2,2', '0.02,-1,2', TreeError, ':4: node 4: parent_id is -1'),
        ('forest.treefile.txt', '0.02,2,2', '0.02,7,2', TreeError, ':4: node 4: parent_id is 7'),
        ('forest.treefile.txt', '0.02,2,2', '0.02,4,2', TreeError, ':4: node 4: cyclic'),
        ('fork.mtg', 'FORM-A', 'FORM-B', FormatError, "the code is 'FORM-B', not FORM-A"),
        ('fork.mtg', 'CODE:', 'CODE', FormatError, "no known tree format|the code is ''"),
        ('fork.mtg', 'ENTITY-CODE', 'ENTITY', FormatError, 'no line ENTITY-CODE'),
        ('fork.mtg', 'SYMBOL', 'SYMB', FormatError, 'no CLASSES'),
        ('fork.mtg', '^<U2', '^<X2', FormatError, ":32: no class 'X'"),
        ('fork.mtg', '^<U2', '^~U2', FormatError, ":32: '~U2' is not a code"),
        ('fork.mtg', '^<U2', '^/U2', TreeError, ':32: U2: scale 3 in scale 3'),
        ('fork.mtg', '\t^/S1', '\t\t\t^/S1', FormatError, ':28: no code in the first 3 columns'),
        ('fork.mtg', '/P1', '\t/P1', TreeError, ":26: '/P1' has no parent"),
        ('fork.mtg', '\tXX', '\tPX', FormatError, 'no two vertices with XX, YY, ZZ'),
    ],
)  # fmt: skip
def test_errors_name_the_line(tmp_path, name, old, new, kind, message):
    text = (DATA / name).read_text()
    assert old in text
    (tmp_path / name).write_text(text.replace(old, new, 1))
    with pytest.raises(TreeSwayError, match=message) as caught:
        read_tree(tmp_path / name)
    assert isinstance(caught.value, kind)
