# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tree_sway.core.tree.building import tree_from_segments
from tree_sway.core.tree.crown_allometry import breast_height_diameter, wood_volume
from tree_sway.files.trees.cylinders.diameter_fit import corrected_twigs, of_usual_wood
from tree_sway.files.trees.source import open_tree
from tree_sway.growth.growing import grow

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


def test_a_scan_that_was_cut_gets_the_wood_of_its_size_and_its_limbs_their_ratios():
    whole = grow('oak', 18.0, rng=np.random.default_rng(3))
    is_branch = np.arange(whole.n_segments) >= whole.branch_first[1]
    wide = np.where(is_branch & (whole.base_diameter > 0.02), 0.016, 0.0)
    scan = replace(
        whole,
        base_diameter=whole.base_diameter + wide,
        tip_diameter=np.maximum(whole.tip_diameter + wide, 0.015 * is_branch),
    )
    drawn = of_usual_wood(scan)
    usual = wood_volume(breast_height_diameter(scan), scan.height)
    wanted = scan.volume.sum() ** 0.2 * usual**0.8
    assert drawn.volume.sum() == pytest.approx(wanted, rel=1e-9)
    assert drawn.volume.sum() < 0.9 * scan.volume.sum()
    ratio = drawn.base_diameter / scan.base_diameter
    np.testing.assert_allclose(ratio[~is_branch], 1.0)
    np.testing.assert_allclose(ratio[is_branch], ratio[-1])


def test_whole_scans_small_ones_and_those_of_few_branches_stay():
    whole = grow('oak', 18.0, rng=np.random.default_rng(3))
    assert of_usual_wood(whole) is whole
    few = open_tree(DATA / 'forest.treefile.txt', tree=1, twig_diameter=0.0).tree
    assert of_usual_wood(few) is few
    small = grow('oak', 3.0, rng=np.random.default_rng(3))
    small = replace(small, tip_diameter=small.tip_diameter + 0.03)
    assert of_usual_wood(small) is small


def test_a_scan_that_was_cut_is_drawn_by_default_which_is_said_and_can_be_left():
    file = Path(__file__).parents[4] / 'examples' / 'data' / 'forest_tree.treeqsm.txt'
    scan = open_tree(file, twig_diameter=0.0).tree
    drawn = open_tree(file)
    assert 0.7 * scan.volume.sum() < drawn.tree.volume.sum() < 0.99 * scan.volume.sum()
    assert any('to the wood of trees of its diameter and height' in note for note in drawn.notes)
    conifer = open_tree(file, species='spruce').tree
    np.testing.assert_array_equal(conifer.base_diameter, scan.base_diameter)
