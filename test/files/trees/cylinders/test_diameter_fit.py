# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest

from tree_sway.core.tree.building import tree_from_segments
from tree_sway.files.trees.cylinders.diameter_fit import corrected_twigs


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
