# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Slopes of the wind load against differences of the load itself."""

from __future__ import annotations

from drawn_trees import crooked, crown
import numpy as np
import pytest

from tree_sway.core.scene.make import make_simulator
from tree_sway.core.setup.load_derivatives import LoadSlopes
from tree_sway.core.setup.wind_moments import WindMoments


@pytest.fixture
def bent():
    """
    Return the loads of a crooked tree, some of its modes, and a pose far from rest.

    Its branches are damped at the mean of their motion, as they are loaded.
    """
    simulator = make_simulator(crooked(8), model=12)
    modal = simulator.banks[0].oscillators.modal
    load = WindMoments(with_mean_damping(modal.branches))
    rng = np.random.default_rng(2)
    return load, modal.shapes, 0.03 * rng.normal(size=load.n)


def with_mean_damping(branches):
    """Return branches that are damped at the mean of their motion, as they are loaded."""
    other = branches.copy()
    other['damping_mode'] = other['load_mode']
    return other


@pytest.mark.parametrize('wind', [(0.8, 0.6, 0.0), (-0.3, 0.5, 0.81), (0.0, 0.0, 1.0)])
def test_slopes_are_those_of_the_load(bent, wind):
    load, shapes, x = bent
    wind, still, size = np.array(wind), np.zeros(load.n), 1e-6
    turning, damping = LoadSlopes(load, shapes)(x, wind)
    moved, swung = np.zeros((2, *turning.shape))
    for k, shape in enumerate(shapes.T):
        step = size / np.abs(shape).max()
        moved[k] = (load(x + step * shape, still, wind) - load(x - step * shape, still, wind)) @ (
            shapes / (2.0 * step)
        )
        swung[k] = (load(x, step * shape, wind) - load(x, -step * shape, wind)) @ (
            shapes / (2.0 * step)
        )
    assert turning == pytest.approx(moved, abs=1e-6 * np.abs(moved).max())
    assert damping == pytest.approx(swung, abs=1e-7 * np.abs(swung).max())


def test_the_damping_of_a_branch_alone_is_that_of_its_points():
    """One branch, whose points are damped more than its mean is."""
    simulator = make_simulator(crown((3, 3, 3)), model=12)
    branches = simulator.banks[0].oscillators.modal.branches
    load, last = WindMoments(branches), branches[-1]
    key = np.zeros((load.n, 1))
    key[last['coordinate']] = 1.0
    still, wind = np.zeros(load.n), np.array([0.6, 0.8, 0.0])
    _, damping = LoadSlopes(load, key)(still, wind)
    swung = load(still, 1e-6 * key[:, 0], wind) - load(still, -1e-6 * key[:, 0], wind)
    at_mean = LoadSlopes(WindMoments(with_mean_damping(branches)), key)(still, wind)[1]
    assert damping[0, 0] == pytest.approx(swung @ key[:, 0] / 2e-6, rel=1e-3)
    assert damping[0, 0] < 1.3 * at_mean[0, 0] < 0.0


def test_a_tree_at_rest_has_slopes_right_to_single_precision(bent):
    load, shapes, _ = bent
    still, wind, size = np.zeros(load.n), np.array([0.6, -0.8, 0.0]), 1e-6
    turning, _ = LoadSlopes(load, shapes)(still, wind)
    shape = shapes[:, 0]
    step = size / np.abs(shape).max() * shape
    moved = (load(step, still, wind) - load(-step, still, wind)) @ shapes
    moved /= 2.0 * size / np.abs(shape).max()
    assert turning[0] == pytest.approx(moved, abs=1e-5 * np.abs(moved).max())
