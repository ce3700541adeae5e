# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The inertia of the bent tree against the kinetic energy of its placed segments."""

from drawn_trees import crooked
import numpy as np
import pytest

from tree_sway.core.scene.make import make_simulator
from tree_sway.core.setup.bent_inertia import inertia_change, MOST_CHANGE
from tree_sway.core.tree.segment_frame import ends_of_poses


def slopes_of(sim):
    """Slopes of the inertia of the first coordinates."""
    return sim.models[0].inertia_slopes


def middles(sim, x):
    return ends_of_poses(sim.place_rotations(x), 0.5 * sim.tree.length)[1]


def inertia(sim, shapes, at, count):
    """Inertia of the first coordinates at a pose, by differences of positions."""
    step = 2e-3 / np.abs(shapes).max(axis=0)
    moved = np.array([
        (middles(sim, shapes @ (at + h)) - middles(sim, shapes @ (at - h))) / (2.0 * h.max())
        for h in np.diag(step)[:count]
    ]).reshape(count, -1)  # fmt: skip
    mass = np.repeat(sim.models[0].species.density * sim.tree.volume, 3)
    return (moved * mass) @ moved.T


@pytest.mark.parametrize('name', ['fork', 'crooked'])
def test_the_inertia_is_that_of_the_kinetic_energy(name, fork):
    tree = fork() if name == 'fork' else crooked(8, 12)
    sim = make_simulator(tree, model=60, in_leaf=False, cache=None)
    shapes, slopes = sim.banks[0].oscillators.shapes, slopes_of(sim)
    count = len(slopes)
    assert count == 12
    expected = np.empty_like(slopes)
    for k in range(count):
        bent = np.zeros(shapes.shape[1])
        bent[k] = 0.01 / np.abs(shapes[:, k]).max()
        ends = (inertia(sim, shapes, s * bent, count) for s in (1.0, -1.0))
        expected[:, :, k] = (next(ends) - next(ends)) / (2.0 * bent[k])
    assert np.linalg.norm(slopes - expected) < 1e-3 * np.linalg.norm(expected)


def test_a_change_of_the_inertia_is_bounded(fork):
    slopes = slopes_of(make_simulator(fork(), model=20, in_leaf=False, cache=None))
    at = np.ones(20)
    small = inertia_change(slopes, 1e-6 * at)
    np.testing.assert_allclose(small, 1e-6 * (slopes @ at[: len(slopes)]), rtol=1e-12)
    assert np.linalg.norm(inertia_change(slopes, 1e6 * at)) == pytest.approx(MOST_CHANGE)


def test_the_inertia_remains_symmetric_on_few_coordinates():
    still = make_simulator(crooked(1, 12), model=3, in_leaf=False, cache=None)
    slopes = slopes_of(still)
    assert slopes.shape == (3, 3, 3)
    np.testing.assert_allclose(slopes, slopes.swapaxes(0, 1), atol=1e-12 * np.abs(slopes).max())
