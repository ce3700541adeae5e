# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest

from tree_sway_ros.core.tree.building import tree_from_segments
from tree_sway_ros.files.trees.cylinders.diameter_fit import corrected_twigs, fitted_taper


def pole(diameter):
    n = len(diameter)
    z = np.linspace(0.0, 4.0, n + 1)
    nodes = np.stack([0 * z, 0 * z, z], axis=1)
    return tree_from_segments(nodes[:-1], nodes[1:], diameter, parent=np.arange(n) - 1)


def true_taper(n):
    x = np.linspace(0.0, 1.0, n + 1)
    line = 0.2 - 0.15 * x
    return 0.5 * (line[:-1] + line[1:]), line


def test_a_clean_taper_is_kept():
    middle, line = true_taper(20)
    tree = fitted_taper(pole(middle))
    np.testing.assert_allclose(tree.base_diameter, line[:-1], rtol=1e-9)
    np.testing.assert_allclose(tree.tip_diameter, line[1:], rtol=1e-9)


def test_a_quarter_of_outliers_does_not_move_it():
    middle, line = true_taper(40)
    rng = np.random.default_rng(3)
    wrong = middle.copy()
    wrong[rng.choice(40, 10, replace=False)] *= 5.0
    tree = fitted_taper(pole(wrong))
    assert np.abs(tree.base_diameter - line[:-1]).max() < 0.01
    least_squares = np.polyval(np.polyfit(np.arange(40), wrong, 1), np.arange(40))
    assert np.abs(least_squares - middle).max() > 0.05


def test_never_wider_to_the_tip_never_nothing():
    tree = fitted_taper(pole(np.linspace(0.01, 0.2, 10)))
    assert (np.diff(tree.base_diameter) <= 0).all()
    steep = fitted_taper(pole([0.3, 0.1, 0.001]))
    assert steep.tip_diameter.min() > 0


def test_long_branches_are_thinned_and_a_single_segment_is_left():
    middle, line = true_taper(1000)
    np.testing.assert_allclose(fitted_taper(pole(middle)).base_diameter, line[:-1], rtol=1e-6)
    assert fitted_taper(pole([0.3])).base_diameter[0] == 0.3


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
