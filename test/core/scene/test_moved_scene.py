# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
import math

import numpy as np
import pytest

from tree_sway.core.scene.placed_tree import PlacedTree
from tree_sway.core.scene.scene import Scene


def turned(points, x, y, z, yaw):
    c, s = math.cos(yaw), math.sin(yaw)
    return np.array([x, y, z]) + points @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]).T


def test_nowhere_else_is_the_same(fork):
    source = Scene([PlacedTree('one', fork())])
    assert source.moved() is source


def test_a_tree_is_moved_and_turned_about_the_origin_of_its_file(fork):
    source = Scene([PlacedTree('one', fork())])
    there = source.moved(x=3.0, y=-2.0, z=0.5, yaw=1.2).tree
    np.testing.assert_allclose(there.end, turned(source.tree.end, 3.0, -2.0, 0.5, 1.2), atol=1e-12)
    np.testing.assert_allclose(there.length, source.tree.length, rtol=1e-12)
    assert there.segment_names == source.tree.segment_names


def test_a_forest_is_moved_as_one(fork):
    trees = [PlacedTree('oak', fork(), x=2.0), PlacedTree('elm', fork(), y=3.0, yaw=0.5)]
    source = Scene(trees, anemometer=(1.0, 0.0, 5.0))
    there = source.moved(x=10.0, z=1.0, yaw=math.pi / 2)
    np.testing.assert_allclose(
        there.tree.end, turned(source.tree.end, 10.0, 0.0, 1.0, math.pi / 2), atol=1e-9
    )
    assert there.anemometer == pytest.approx((10.0, 1.0, 6.0))
