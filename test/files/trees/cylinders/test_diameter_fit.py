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


def test_what_is_as_thick_as_ends_are_becomes_a_twig():
    tree = pole([0.20, 0.10, 0.05, 0.04, 0.03, 0.02])
    corrected = corrected_twigs(tree, twig_diameter=0.002, trusted_diameter=0.05)
    np.testing.assert_array_equal(corrected.base_diameter[:3], [0.20, 0.10, 0.05])
    np.testing.assert_allclose(corrected.base_diameter[3:], [0.034, 0.018, 0.002])
    assert corrected.volume.sum() < tree.volume.sum()


@pytest.mark.parametrize('end', [0.06, 0.001])
def test_a_scan_without_thick_twigs_stays_as_it_is(end):
    tree = pole([0.20, 0.10, 0.04, end])
    np.testing.assert_array_equal(corrected_twigs(tree, 0.002, 0.05).volume, tree.volume)


def test_nothing_becomes_thicker():
    tree = tree_from_segments(
        [[0, 0, 0], [0, 0, 1], [0, 0, 1]], [[0, 0, 1], [1, 0, 1], [0, 1, 1]],
        [0.01, 0.001, 0.01], parent=[-1, 0, 0], branch=[0, 1, 2],
    )  # fmt: skip
    corrected = corrected_twigs(tree, twig_diameter=0.003, trusted_diameter=0.05)
    np.testing.assert_allclose(corrected.tip_diameter, [0.003, 0.001, 0.003])


def test_scans_are_corrected_by_species_unless_it_is_switched_off():
    scan = DATA / 'fork.treeqsm24.txt'
    thin = {'diameter_unit': 0.12}
    as_scanned = open_tree(scan, twig_diameter=0.0, **thin).tree
    for species, twig in (('ash', 0.0045), ('birch', 0.0017)):
        opened = open_tree(scan, species=species, trusted_diameter=0.024, thicken=False, **thin)
        off = 1.0 - opened.tree.volume.sum() / as_scanned.volume.sum()
        assert opened.tree.tip_diameter[-1] == pytest.approx(twig)
        assert f': {100.0 * off:.0f} % of the wood taken off' in opened.notes[0]
    cut = open_tree(scan, trusted_diameter=0.2, thicken=False)
    assert cut.tree.tip_diameter[-1] == pytest.approx(0.04)
    measured = open_tree(DATA / 'fork.swc', tree=1)
    assert not any('wood' in note for note in measured.notes)
