# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Half an hour in a light wind tells the first frequency, the damping and the drag of a tree."""

from __future__ import annotations

import math

import numpy as np
import pytest
from tree_sway_lab.twin.simulated_sensor import SimulatedSensor
from tree_sway_lab.twin.true_tree import (
    Circumstances,
    DT,
    pose_at,
    sensor_places,
    tree_called,
    true_simulator,
    winds,
)

from tree_sway.core.setup.threads import one_thread
from tree_sway.twin.observed_tree import ObservedTree
from tree_sway.twin.sensor_place import place_on


@pytest.mark.long
@pytest.mark.parametrize('drag', [0.8, 1.0])
def test_half_an_hour_tells_frequency_damping_and_drag(drag: float) -> None:
    tree, species = tree_called('spruce 8')
    around = Circumstances(wood=0.85, damping=1.5, drag=drag, speed=5.0, seconds=1800.0, seed=215)
    (at,) = sensor_places(tree, 1)
    with one_thread():
        true = true_simulator(tree, species, around, in_leaf=False, model=90)
        felt, measured = winds(around)
        place, block = place_on(tree, at), np.empty((tree.n_segments, 7))
        poses = np.empty((len(felt), 7))
        for k, each in enumerate(felt):
            true.step(each, DT)
            true.place(block)
            poses[k] = pose_at(tree, block, place)
        twin = ObservedTree(tree, species, in_leaf=False, at={at: at})
        motion = SimulatedSensor().measured(poses, DT, np.random.default_rng(7))
        twin.replay(at, motion.time, acceleration=motion.acceleration, rate=motion.rate)
        for each in measured:
            twin.step(each, DT)
    learned = twin.learned
    print(learned)
    assert learned is not None
    assert learned.frequency == pytest.approx(float(true.frequencies(1)[0]), rel=0.02)
    assert learned.damping == pytest.approx(1.5, rel=0.3)
    assert abs(math.log(learned.drag / drag)) < 2.0 * learned.drag_error
    assert learned.hours > 0.4
