# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Without a sensor a tree sways as the mean of all wood, with one as its own."""

from __future__ import annotations

from drawn_trees import crown
import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.run import SwaySimulator
from tree_sway.core.scene import make_simulator
from tree_sway.twin import ObservedTree

TREE = crown((4, 2), 4)


def damping(sim: SwaySimulator) -> Floats:
    """Damping of the coordinates."""
    return sim.banks[0].oscillators.tunable.damping.copy()


def test_a_sensor_tells_the_wood_of_its_tree() -> None:
    with_sensor = ObservedTree(TREE, at={'phone': 'stem:0.5'}, anemometer_distance=12.0)
    without = ObservedTree(TREE, at={}, anemometer_distance=12.0)
    expected = make_simulator(TREE, anemometer_distance=12.0)
    np.testing.assert_array_equal(damping(with_sensor), damping(make_simulator(TREE)))
    np.testing.assert_array_equal(damping(without), damping(expected))
