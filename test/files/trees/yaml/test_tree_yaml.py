# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
import math
from pathlib import Path

import numpy as np
import pytest

from tree_sway.core.species.species import species_named
from tree_sway.errors import FormatError, SpeciesError, TreeError, TreeSwayError
from tree_sway.files.trees.yaml.tree_yaml import parse_yaml_tree, read_yaml_tree

DATA = Path(__file__).parents[2] / 'data'
STEM = 'branches:\n- name: stem\n  nodes: [[0, 0, 0, .1], [0, 0, 1, .1], [0, 0, 2, .08]]\n'


def test_hand_written_tree():
    tree_file = read_yaml_tree(DATA / 'seedling.yaml')
    tree = tree_file.tree
    assert tree.name == 'seedling'
    assert tree.branch_names == ('stem', 'twig', 'loose', 'leader shoot')
    assert tree.n_segments == 6
    np.testing.assert_allclose(tree.start[2], [0, 0, 0.4])
    np.testing.assert_allclose(tree.end[2], [0.2, 0, 0.5])
    np.testing.assert_allclose(tree.start[4], [0, 0, 0.7])
    assert list(tree.segment_parent) == [-1, 0, 0, 2, 1, 4]
    np.testing.assert_array_equal(tree.base_diameter[4:], [0.004, 0.003])
    np.testing.assert_array_equal(tree.tip_diameter[4:], [0.004, 0.002])


def test_wood_replaces_the_tables_values():
    species = read_yaml_tree(DATA / 'seedling.yaml').species
    oak = species_named('oak')
    assert species.modulus == 8e9
    assert species.density == oak.density
    assert (species.damping_bare, species.damping_in_leaf) == (0.05, 0.05)


def test_a_tree_gives_its_own_shear_and_roots():
    wood = parse_yaml_tree(STEM + 'wood: {shear_ratio: 0.05, root_stiffness: 2.5e6}\n').species
    assert (wood.shear_ratio, wood.root_stiffness) == (0.05, 2.5e6)
    assert parse_yaml_tree(STEM).species.root_stiffness == math.inf
    with pytest.raises(FormatError, match=r"wood\.root_stiffness is '0'; give a number of more"):
        parse_yaml_tree(STEM + 'wood: {root_stiffness: 0}\n')


def test_a_measured_modulus_is_no_estimate():
    assert parse_yaml_tree(STEM + 'species: benjamina\n').species.is_estimate
    text = STEM + 'species: benjamina\nwood: {modulus: 7.5e9}\n'
    assert not parse_yaml_tree(text).species.is_estimate


@pytest.mark.parametrize(
    ('text', 'kind', 'message'),
    [
        ('', FormatError, 't: empty'),
        ('a: [1', FormatError, 't:2: not YAML'),
        ('name: x', FormatError,
         "t:1: the file has no 'branches'; add 'branches': The branches, .*`tree-sway grow`"),
        ('[1, 2]', FormatError, 't:1: the file is a list of 2; give a mapping'),
        (STEM + 'name: {a: b}\n', FormatError, 't:4: name is a mapping of 1; give a text'),
        (STEM + 'name: a\nname: b\n', FormatError,
         "t:5: key 'name' occurs twice, first in line 4"),
        (STEM + 'nmae: x\n', FormatError,
         "t:4: unknown key 'nmae' in the file; did you mean 'name'"),
        (STEM + 'x: &a 1\n', FormatError, 't:4: an anchor or alias'),
        (STEM + 'x: !!int 1\n', FormatError, 't:4: a tag'),
        (STEM + '---\na: 1\n', FormatError, 't:4: not YAML: but found another document'),
        (STEM + 'x: ' + 20 * '[' + 20 * ']', FormatError, 't:4: nested deeper'),
        (STEM + '[1]: x\n', FormatError, 't:4: a list as a key'),
        ('branches: []\n', FormatError,
         r't:1: branches is a list of 0; give a list of at least 1'),
        (STEM + 'species: oka\n', SpeciesError, "t:4: unknown species 'oka'"),
        (STEM + 'wood: {modulus: -1}\n', FormatError,
         "t:4: wood.modulus is '-1'; give a number of more than 0, finite, without quotes"),
        (STEM + "wood: {modulus: '1e9'}\n", FormatError,
         "t:4: wood.modulus is '1e9'; give a number of more than 0, finite, without quotes"),
        (STEM + 'wood: {damping_ratio: 11}\n', FormatError,
         "t:4: .* is '11'; give a number of at least 0 and at most 10"),
        (STEM + 'wood: {damping_ratio: .1, damping_bare: .1}', FormatError,
         't:4: both damping_ratio'),
        (STEM.replace('1, .1', '.nan, .1'), FormatError,
         r"t:3: branches\[0\].nodes\[1\]\[2\] is '.nan'"),
        (STEM.replace('1, .1', '.inf, .1'), FormatError, "is '.inf'; give a number, finite"),
        (STEM.replace('1, .1', '1e999, .1'), FormatError, "is '1e999'; give a number"),
        (STEM.replace('1, .1', '1 m, .1'), FormatError, "is '1 m'; give a number"),
        (STEM.replace('1, .1', '1'), FormatError,
         r'nodes\[1\] is a list of 3; give a list of at least 4 and at most 4'),
        (STEM.replace('1, .1', '0, .1'), TreeError,
         "t:3: segment 0 of branch 'stem': zero length"),
        (STEM.replace('.08', '-.08'), TreeError, "t:3: segment 1 of branch 'stem': diameter"),
        (STEM.replace('2, .08', '1e30, .08'), TreeError, 't:3: segment 1 .* too large for metres'),
        (STEM.replace('name: stem', 'parent: stem'), FormatError, r"branches\[0\] has no 'name'"),
        (STEM.replace('nodes', 'x'), FormatError, r"unknown key 'x' in branches\[0\]"),
    ],
)  # fmt: skip
def test_one_clear_error(text, kind, message):
    with pytest.raises(kind, match=message) as caught:
        parse_yaml_tree(text, 't')
    assert isinstance(caught.value, TreeSwayError)
    assert '\n' not in str(caught.value)


BRANCH = '  nodes: [[0, 0, 1, .05], [1, 0, 1, .05]]\n'


@pytest.mark.parametrize(
    ('branch', 'kind', 'message'),
    [
        ('- name: a\n' + BRANCH, TreeError, "t:4: branch 'a': a second branch without a parent"),
        ('- name: stem\n  parent: stem\n' + BRANCH, FormatError, 't:4: .* the first is at t:2'),
        ('- name: a\n  parent: sten\n' + BRANCH, TreeError,
         "orphan: no branch 'sten'; did you mean 'stem'"),
        ('- name: a\n  parent: a\n' + BRANCH, TreeError, "t:4: branch 'a': cyclic"),
        ('- name: a\n  parent: stem\n', FormatError,
         "t:4: branch 'a': neither nodes nor segments"),
        ('- name: a\n  parent: stem\n  segment: 2\n' + BRANCH, FormatError,
         'no segment 2 .* from 0 to 1'),
        ('- name: a\n  parent: stem\n  segment: 1.5\n' + BRANCH, FormatError,
         "is '1.5'; give a whole"),
        ('- name: a\n  parent: stem\n  at: 2\n' + BRANCH, FormatError,
         "at is '2'; give a number of at least 0 and at most 1"),
        ('- name: a\n  parent: stem\n  at: [0, 0, 0]\n' + BRANCH, FormatError,
         'at is a list of 3; give a number of'),
        ('- name: a\n  parent: stem\n  at: 1\n  segment: 0\n' + BRANCH, FormatError,
         'both at and segment'),
        ('- name: a\n  parent: stem\n' + BRANCH.replace('[[0', '[[.5'), TreeError,
         'starts 0.5 m off its parent'),
    ],
)  # fmt: skip
def test_errors_of_branches(branch, kind, message):
    with pytest.raises(kind, match=message):
        parse_yaml_tree(STEM + branch, 't')


def test_missing_file_and_binary_file(tmp_path):
    with pytest.raises(FormatError, match='no such file'):
        read_yaml_tree(tmp_path / 'none.yaml')
    (tmp_path / 'binary.yaml').write_bytes(b'\xff\xfe\x00')
    with pytest.raises(FormatError, match='not UTF-8 text: byte 0 is 0xff'):
        read_yaml_tree(tmp_path / 'binary.yaml')
    with pytest.raises(FormatError, match='not a file'):
        read_yaml_tree(tmp_path)
