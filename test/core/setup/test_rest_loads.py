# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Loads at rest: those of the law on straight branches, and the power of each segment's drag."""

from __future__ import annotations

from drawn_trees import crooked, SETTINGS, WOOD
import numpy as np
import pytest

from tree_sway.core.scene import make_simulator
from tree_sway.core.setup import prepare, TreeReductions
from tree_sway.core.setup.rest_loads import rest_loads
from tree_sway.core.tree import tips_of_poses

WINDS = np.array([[0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [0.8, 0.0, 0.6], [0.6, 0.8, 0.0]])


def power_of_segments(tree, model, winds, step=1e-5):
    """Return the power (k, m) of the drag of each whole segment as coordinates move it."""
    along = tree.end - tree.start
    tangent = along / np.linalg.norm(along, axis=1, keepdims=True)
    area = np.linalg.norm(along, axis=1) * 0.5 * (tree.base_diameter + tree.tip_diameter)
    simulator = make_simulator(model)
    eta = simulator.banks[0].stand.states.eta
    count = model.shapes.shape[1]
    power = np.zeros((len(winds), count))
    is_last = np.append(tree.branch_of_segment[1:] != tree.branch_of_segment[:-1], True)
    centre = (tree.base_diameter + 2.0 * tree.tip_diameter)[:, None] / 3.0
    centre /= (tree.base_diameter + tree.tip_diameter)[:, None]
    across = winds[:, None] - (winds @ tangent.T)[..., None] * tangent
    force = area[:, None] * across * np.linalg.norm(across, axis=-1, keepdims=True)
    for k in range(count):
        middles = []
        for way in (step, -step):
            simulator.reset()
            eta[0, k] = way
            poses = simulator.place()
            start = poses[:, :3]
            end = np.vstack([start[1:], start[-1:]])
            end[is_last] = tips_of_poses(tree, poses)
            middles.append(start + centre * (end - start))
        moved = (middles[0] - middles[1]) / (2.0 * step)
        power[:, k] = np.einsum('ksi,si->k', force, moved)
    return power


def test_a_wind_straight_up_meets_each_segment_at_its_own_angle() -> None:
    tree = crooked(8, 12)
    reductions = TreeReductions(tree, WOOD, SETTINGS)
    model = prepare(tree, WOOD, SETTINGS, model=8)
    loads = rest_loads(reductions.with_subtrees, model.shapes, None, WINDS)
    np.testing.assert_allclose(loads[1], -loads[0])
    expected = power_of_segments(tree, model, WINDS)
    for load, each in zip(loads, expected, strict=True):
        assert np.linalg.norm(load - each) < 0.02 * np.linalg.norm(each)
    law = reductions.wind_moments.at_rest(WINDS, model.shapes)
    assert np.linalg.norm(law[3] - loads[3]) < 0.01 * np.linalg.norm(loads[3])
    assert np.linalg.norm(law[0] - loads[0]) > 0.03 * np.linalg.norm(loads[0])


def test_the_loads_of_parts_add_up() -> None:
    reduced = TreeReductions(crooked(8, 12), WOOD, SETTINGS).with_subtrees
    shapes = np.random.default_rng(1).normal(size=(reduced.reduction.n_coordinates, 3))
    is_first = np.arange(len(reduced.branches)) % 2 == 0
    parts = [rest_loads(reduced, shapes, some, WINDS) for some in (is_first, ~is_first)]
    assert sum(parts) == pytest.approx(rest_loads(reduced, shapes, None, WINDS))
