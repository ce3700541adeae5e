# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
from pathlib import Path

import numpy as np
import pytest

from tree_sway.core.tree.building import tree_from_segments
from tree_sway.files.trees.cylinders.diameter_fit import corrected_twigs
from tree_sway.files.trees.source import open_tree

DATA = Path(__file__).parents[2] / 'data'


def pole(diameter):
    n = len(diameter)
    z = np.linspace(0.0, 4.0, n + 1)
    nodes = np.stack([0 * z, 0 * z, z], axis=1)
    return tree_from_segments(nodes[:-1], nodes[1:], diameter, parent=np.arange(n) - 1)


def test_twigs_taper_to_what_was_measured():
    tree = pole([0.20, 0.10, 0.05, 0.05, 0.05, 0.05])
    corrected = corrected_twigs(tree, twig_diameter=0.002, trusted_diameter=0.06)
    np.testing.assert_array_equal(corrected.base_diameter[:2], [0.20, 0.10])
    assert corrected.base_diameter[2] == 0.05
    assert corrected.tip_diameter[-1] == pytest.approx(0.002)
    assert (np.diff(corrected.base_diameter) <= 0).all()
    assert corrected.volume.sum() < tree.volume.sum()


def test_a_thin_branch_is_no_thicker_than_its_parent():
    tree = tree_from_segments(
        [[0, 0, 0], [0, 0, 1]], [[0, 0, 1], [1, 0, 1]], [0.02, 0.04], parent=[-1, 0], branch=[0, 1]
    )
    corrected = corrected_twigs(tree, twig_diameter=0.004, trusted_diameter=0.05)
    assert corrected.base_diameter[1] == pytest.approx(0.02)
    assert corrected.tip_diameter[1] == pytest.approx(0.004)


def test_a_thin_cylinder_within_a_stem_does_not_make_it_a_twig():
    tree = pole([0.20, 0.04, 0.18, 0.16])
    np.testing.assert_array_equal(corrected_twigs(tree, 0.002, 0.05).volume, tree.volume)


def test_no_wood_is_added_to_thin_tips():
    tree = pole([0.03, 0.02, 0.001, 0.0005])
    corrected = corrected_twigs(tree, twig_diameter=0.003, trusted_diameter=0.05)
    assert corrected.tip_diameter[-1] == pytest.approx(0.0005)


def test_scans_are_corrected_by_species_unless_it_is_switched_off():
    scan = DATA / 'fork.treeqsm24.txt'
    as_scanned = open_tree(scan, twig_diameter=0.0).tree
    for species, twig in (('ash', 0.0045), ('birch', 0.0017)):
        opened = open_tree(scan, species=species)
        off = 1.0 - opened.tree.volume.sum() / as_scanned.volume.sum()
        assert opened.tree.tip_diameter.min() == pytest.approx(twig)
        assert f': {100.0 * off:.0f} % of the wood taken off' in opened.notes[0]
    measured = open_tree(DATA / 'fork.swc', tree=1)
    assert not any('wood' in note for note in measured.notes)
