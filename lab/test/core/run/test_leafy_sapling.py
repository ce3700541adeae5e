# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A sapling whose light leaves have more drag than inertia, against all coordinates."""

from __future__ import annotations

import numpy as np
import pytest
from tree_sway_lab.example_trees import leafy_sapling

from tree_sway.core.scene.make import make_simulator
from tree_sway.core.species.wood import Species
from tree_sway.core.tree.tree import tips_of_poses
from tree_sway.core.wind.turbulence import simulate_turbulence

DT = 1.0 / 60.0
WOOD = Species('sapling', 'sapling', modulus=9.0e9, density=900.0, damping_in_leaf=0.10)
LEAF_MASS, LEAF_AREA = 0.0009, 0.0060


@pytest.fixture(scope='module')
def sapling():
    """Return the sapling whose stem is straight."""
    return leafy_sapling()


def simulator(tree, model):
    on_petioles = np.ones(tree.n_branches)
    on_petioles[0] = 0.0
    return make_simulator(
        tree, WOOD, model=model, in_leaf=True, cache=None,
        leaf_mass=LEAF_MASS * on_petioles, leaf_area=LEAF_AREA * on_petioles,
    )  # fmt: skip


def sway(sim, speed, seconds=12.0, n_substeps=1, factor=1.0):
    """Tips over time from rest on, (t, b, 3), in a wind times a factor."""
    rng = np.random.default_rng(3)
    wind = factor * simulate_turbulence(speed, rate=60.0, duration=seconds, rng=rng)
    sim.reset()
    rest, tips = tips_of_poses(sim.tree, sim.place()), []
    for each in wind:
        for _ in range(n_substeps):
            sim.step(each, DT / n_substeps)
        tips.append(tips_of_poses(sim.tree, sim.place()) - rest)
    return np.array(tips)


@pytest.mark.parametrize('speed', [3.0, 8.0, 12.0, 16.0])
def test_the_default_sways_as_all_coordinates_with_the_load_of_every_branch(sapling, speed):
    usual, full = simulator(sapling, 60), simulator(sapling, 'full')
    assert usual.banks[0].oscillators.shapes.shape[1] < 60  # its stiffest are in the table
    shown, right = sway(usual, speed), sway(full, speed)
    assert usual.counts.clamped == usual.counts.restarted == 0
    error = np.linalg.norm(shown - right) / np.linalg.norm(right)
    assert error < 0.05, error


@pytest.mark.parametrize('seed', [None, 1, 2, 3])
@pytest.mark.parametrize(('speed', 'n_substeps'), [(12.0, 8), (20.0, 8), (20.0, 16), (25.0, 12)])
def test_all_coordinates_sway_alike_at_shorter_steps(sapling, speed, n_substeps, seed):
    """Drag that stops a coordinate of a bent stem within a hundredth of a step is solved for."""
    tree = sapling if seed is None else leafy_sapling(0.012, seed)
    full = simulator(tree, 'full')
    shown = sway(full, speed, seconds=6.0, n_substeps=4)
    finer = sway(full, speed, seconds=6.0, n_substeps=n_substeps)
    assert full.counts.clamped == 0
    assert np.linalg.norm(finer - shown) < 0.03 * np.linalg.norm(finer)


@pytest.mark.parametrize(('speed', 'n_substeps'), [(25.0, 12), (30.0, 12)])
def test_rounding_does_not_decide_whether_all_coordinates_stay_in_bounds(
    sapling, speed, n_substeps
):
    """A few steps in a storm whose load is not solved for throw the tree."""
    full = simulator(sapling, 'full')
    first = sway(full, speed, seconds=6.0, n_substeps=n_substeps)
    for nudge in (1e-13, 2e-13, 3e-13, 4e-13):
        other = sway(full, speed, seconds=6.0, n_substeps=n_substeps, factor=1.0 + nudge)
        assert full.counts.clamped == full.counts.restarted == 0
        error = np.linalg.norm(other - first) / np.linalg.norm(first)
        assert error < 1e-3, error
