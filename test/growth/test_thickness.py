# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The pipe model on trees small enough to compute by hand."""

import numpy as np
import pytest

from tree_sway.errors import ParameterError
from tree_sway.growth.skeleton import Skeleton
from tree_sway.growth.thickness import carried_length, node_diameters


def fork() -> Skeleton:
    """Make a stem of three metres with two twigs of half a metre on its second node."""
    skeleton = Skeleton()
    stem = skeleton.add(np.array([[0.0, 0, 0], [0, 0, 1], [0, 0, 2], [0, 0, 3]]))
    for side in (-1.0, 1.0):
        skeleton.add(np.array([[0.0, 0, 2], [0.5 * side, 0, 2]]), stem, 2)
    return skeleton


def test_carried_length_counts_everything_beyond() -> None:
    stem, left, right = carried_length(fork())
    np.testing.assert_allclose(stem, [4.0, 3.0, 2.0, 0.0])
    np.testing.assert_allclose(left, [0.5, 0.0])
    np.testing.assert_allclose(right, left)


def test_areas_add_up_with_exponent_two() -> None:
    stem, left, _ = node_diameters(fork(), 0.04, at_height=0.0, tip_diameter=0.01, exponent=2.0)
    assert stem[0] == pytest.approx(0.04)
    assert stem[-1] == pytest.approx(0.01)
    # Area in units of the tip's: 1 + 15 W / 4.
    np.testing.assert_allclose((stem / 0.01) ** 2, 1.0 + 15.0 / 4.0 * np.array([4, 3, 2, 0]))
    assert (left[0] / 0.01) ** 2 == pytest.approx(1.0 + 15.0 / 8.0)


def test_the_given_diameter_is_where_it_was_measured() -> None:
    stem = node_diameters(fork(), 0.03, at_height=1.3, tip_diameter=0.004)[0]
    assert np.interp(1.3, [0, 1, 2, 3], stem) == pytest.approx(0.03, rel=1e-12)


def test_a_parent_is_thick_enough_for_a_child_that_carries_nearly_all() -> None:
    skeleton = Skeleton()
    stem = skeleton.add(np.array([[0.0, 0, 0], [0, 0, 1.0], [0, 0, 1.1]]))
    branch = skeleton.add(np.array([[0.0, 0, 1], [1.0, 0, 1], [1.1, 0, 1]]), stem, 1)
    skeleton.add(np.array([[1.0, 0, 1], [4.0, 0, 1]]), branch, 1)
    below, middle, child = node_diameters(skeleton, 0.05, at_height=0.0, tip_diameter=0.002)
    assert child[0] / middle[1] == pytest.approx(0.76)
    assert middle[0] / below[1] <= 0.76 * (1.0 + 1e-12)
    assert below[0] == pytest.approx(0.05)


def test_a_stem_thinner_than_its_tips_is_refused() -> None:
    with pytest.raises(ParameterError, match=r'too thin.*more than 0\.02 m'):
        node_diameters(fork(), 0.015, at_height=0.0, tip_diameter=0.01)
