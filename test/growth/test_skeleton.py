# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Shoots put together, scaled, and turned into a tree."""

import numpy as np
import pytest

from tree_sway.growth.skeleton import Skeleton


def tripod() -> Skeleton:
    """Make a stem of 3 segments, a branch of 2 with a twig on its first node, one at the top."""
    skeleton = Skeleton()
    stem = skeleton.add(np.array([[1.0, 1, 0], [1, 1, 1], [1, 1, 2], [1, 1, 3]]))
    low = skeleton.add(np.array([[1.0, 1, 1], [2, 1, 1], [3, 1, 1]]), stem, 1)
    skeleton.add(np.array([[2.0, 1, 1], [2, 2, 1]]), low, 1)
    skeleton.add(np.array([[1.0, 1, 3], [1, 1, 4]]), stem, 3)
    return skeleton


def some_diameters(skeleton: Skeleton) -> list[np.ndarray]:
    return [
        np.linspace(0.1, 0.05, len(shoot.nodes)) / (i + 1)
        for i, shoot in enumerate(skeleton.shoots)
    ]


def test_every_shoot_becomes_a_branch_on_its_node() -> None:
    skeleton = tripod()
    tree = skeleton.to_tree(some_diameters(skeleton), 'tripod', 'oak')
    assert (tree.name, tree.species) == ('tripod', 'oak')
    assert tree.n_segments == skeleton.n_segments == 7
    np.testing.assert_array_equal(np.diff(tree.branch_first), [3, 2, 1, 1])
    np.testing.assert_array_equal(tree.branch_parent, [-1, 0, 1, 0])
    # The branch sits on the first segment of the stem, the twig on the first of the branch.
    np.testing.assert_array_equal(tree.segment_parent, [-1, 0, 1, 0, 3, 3, 2])
    np.testing.assert_array_equal(tree.start[1:], tree.end[tree.segment_parent[1:]])


def test_diameters_are_those_of_the_nodes() -> None:
    skeleton = tripod()
    tree = skeleton.to_tree(some_diameters(skeleton), 'tripod', 'oak')
    np.testing.assert_allclose(tree.base_diameter[:3], [0.1, 0.05 * 5 / 3, 0.05 * 4 / 3])
    np.testing.assert_allclose(tree.tip_diameter[:3], [0.05 * 5 / 3, 0.05 * 4 / 3, 0.05])
    assert tree.base_diameter[3] == pytest.approx(0.05)


def test_scaling_reaches_the_height_and_puts_the_root_at_the_origin() -> None:
    skeleton = tripod()
    skeleton.scale_to_height(10.0)
    tree = skeleton.to_tree(some_diameters(skeleton), 'tripod', 'oak')
    np.testing.assert_array_equal(tree.start[0], 0.0)
    assert tree.height == 10.0
    # The top is the twig's on the stem, at 4 before; all else keeps its shape.
    np.testing.assert_allclose(tree.end[4], [5.0, 0.0, 2.5])


def test_tangent_is_that_of_the_segment_below_a_node() -> None:
    low = tripod().shoots[1]
    for node in range(3):
        np.testing.assert_array_equal(low.tangent(node), [1.0, 0.0, 0.0])
