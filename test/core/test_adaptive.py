"""Models that change unseen."""

from __future__ import annotations

import numpy as np
import pytest

from tree_sway_ros.core.adaptive import CROSS_FADE, REVIEW, RUN_IN, AdaptiveSimulator
from tree_sway_ros.core.reference.example_trees import forked_tree
from tree_sway_ros.core.settings import SimulatorSettings
from tree_sway_ros.core.species import Species
from tree_sway_ros.core.turbulence import simulate_turbulence

DT = 1.0 / 60.0
WOOD = Species("example", "example", 8e9, 900.0, damping_bare=0.08)


@pytest.fixture
def tree():
    return forked_tree(0.5, 0.6)


def adaptive(tree, tolerance):
    return AdaptiveSimulator(tree, WOOD, SimulatorSettings(gravity=0.0), tolerance=tolerance)


def test_a_far_tree_stands_still_and_a_near_one_is_solved(tree):
    assert adaptive(tree, 10.0).rung == "frozen"
    assert adaptive(tree, 0.01).rung in ("modes", "coupled")


def test_a_tolerance_nobody_can_meet_takes_the_best(tree):
    assert adaptive(tree, 1e-9).rung == "coupled"


def test_coming_nearer_changes_the_model_without_a_step(tree):
    sim = adaptive(tree, 10.0)
    wind = simulate_turbulence(5.0, rate=60, duration=40, rng=np.random.default_rng(3), height=10.0)
    frames, changed_at = [], None
    for i, w in enumerate(wind):
        if i == 1200:
            sim.tolerance = 0.004
        sim.step(w, DT)
        frames.append(sim.place().copy())
        if changed_at is None and sim.rung != "frozen":
            changed_at = i
    assert changed_at is not None
    waited = (changed_at - 1200) * DT
    assert RUN_IN + CROSS_FADE <= waited + 2 * DT <= RUN_IN + CROSS_FADE + REVIEW + 2 * DT
    moves = np.linalg.norm(np.diff(np.array(frames)[:, :, :3], axis=0), axis=2).max(axis=1)
    fading = moves[changed_at - int(CROSS_FADE / DT) - 2 : changed_at + 1]
    afterwards = moves[changed_at + 1 :]
    swing = np.abs(frames[changed_at + 1][:, :3] - frames[0][:, :3]).max()
    assert fading.max() <= 2.0 * swing * DT / CROSS_FADE + afterwards.max()
    assert moves[changed_at - 1 : changed_at + 1].max() <= 2.0 * afterwards.max()


def test_poses_stay_rotations_while_they_fade(tree):
    sim = adaptive(tree, 10.0)
    sim.tolerance = 0.004
    for _ in range(int((REVIEW + RUN_IN + 0.5 * CROSS_FADE) / DT)):
        sim.step((6.0, 1.0, 0.0), DT)
    assert sim.is_changing
    np.testing.assert_allclose(np.linalg.norm(sim.place()[:, 3:], axis=1), 1.0, atol=1e-12)


def test_a_wind_on_the_border_does_not_flicker(tree):
    sim = adaptive(tree, 0.01)
    rng = np.random.default_rng(4)
    changes, before = 0, sim.choice.name
    for _ in range(60):
        for _ in range(60):
            sim.step((6.0 + 0.3 * rng.standard_normal(), 0.0, 0.0), DT)
        changes += sim.choice.name != before
        before = sim.choice.name
    assert changes <= 2


def test_reset_and_bad_wind_as_in_one_simulator(tree):
    sim = adaptive(tree, 0.05)
    rest = sim.place().copy()
    assert sim.step((np.nan, 0.0, 0.0), DT) == 1
    assert sim.counts.refused == 1
    for _ in range(60):
        sim.step((5.0, 0.0, 0.0), DT)
    sim.reset()
    np.testing.assert_array_equal(sim.place(), rest)
