# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A branch that is pushed moves as with all coordinates."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from tree_sway_lab.bench.bench_tree import bench_tree
from tree_sway_lab.kinds.kinds import kind_called
from tree_sway_lab.validation.truth import WOOD

from tree_sway.core.scene.make import make_simulator

DT = 1.0 / 60.0
CALM = (0.0, 0.0, 0.0)
SETTLING, DAMPING = 5.0, 0.3
"""Time in which a tree that is damped so comes to rest [s], and the ratio of its damping."""


@pytest.fixture(scope='module')
def tree():
    return bench_tree()


def place_of(poses, tree, segment, along=0.5):
    """Where on a segment the push acts, (3,)."""
    away = (along * tree.length[segment], 0.0, 0.0)
    return poses[segment, :3] + Rotation.from_quat(poses[segment, 3:]).apply(away)


def moved(sim, segment):
    """Displacement from rest of the middle of a segment, (3,)."""
    tree = sim.tree
    return place_of(sim.place(), tree, segment) - 0.5 * (tree.start[segment] + tree.end[segment])


def outer_segment(tree):
    """Return a segment half way along the last branch, far from the root."""
    return int(tree.branch_first[-2] + 2)


FORCE = np.array([3.0, 1.0, -0.5])


@cache
def held_back(model):
    """Simulate a tree that hangs at rest from a force on its outer segment."""
    sim = make_simulator(bench_tree(), WOOD, model=model)
    for _ in range(round(15.0 / DT)):
        sim.push(outer_segment(sim.tree), FORCE, 1.0)
        sim.step(CALM, DT)
    return sim


@pytest.mark.parametrize('model', [60, 'auto', 'full'])
def test_every_model_moves_by_the_same_and_the_foot_holds_the_force(tree, model):
    segment, sim = outer_segment(tree), held_back(model)
    truth, found = moved(held_back('full'), segment), moved(sim, segment)
    assert np.linalg.norm(found - truth) < 0.05 * np.linalg.norm(truth)
    assert found @ FORCE > 0.0
    np.testing.assert_allclose(sim.push_load[:3], FORCE)
    arm = place_of(sim.place(), tree, segment) - tree.start[0]
    np.testing.assert_allclose(sim.push_load[3:], np.cross(arm, FORCE), rtol=1e-3)


def test_a_pull_moves_a_tree_further_than_any_wind_may():
    tree, segment, force = kind_called('leaning'), 7, np.array([8000.0, 2400.0, 0.0])
    table, truth = (make_simulator(tree, WOOD, model=each) for each in (60, 'full'))
    for _ in range(round(5.0 / DT)):
        for sim in (table, truth):
            sim.push(segment, force, 1.0)
            sim.step(CALM, DT)
    model, eta = table.models[0], table.banks[0].oscillators.swing[0]
    assert model.stiffness @ eta**2 > model.most_energy
    there = moved(truth, segment)
    assert np.linalg.norm(moved(table, segment) - there) < 0.05 * np.linalg.norm(there)
    assert table.counts.clamped == 0


def test_in_wind_it_adds_to_what_the_wind_does(tree):
    segment = outer_segment(tree)
    moves = []
    for model in ('full', 60):
        rests = []
        for force in (0.0, 3.0):
            sim = make_simulator(tree, WOOD, model=model, damping_ratio=DAMPING)
            for _ in range(round(SETTLING / DT)):
                sim.push(segment, (0.0, force, 0.0), 1.0)
                sim.step((6.0, 0.0, 0.0), DT)
            rests.append(moved(sim, segment))
        moves.append(rests[1] - rests[0])
    assert np.linalg.norm(moves[1] - moves[0]) < 0.1 * np.linalg.norm(moves[0])
