# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A sapling whose light leaves have more drag than inertia: stiff coordinates in a table."""

from __future__ import annotations

from drawn_trees import Sketch, UP
import numpy as np
import pytest

from tree_sway.core.oscillators.propagation import propagator, step_propagators
from tree_sway.core.scene.make import make_simulator
from tree_sway.core.species.wood import Species

WOOD = Species('sapling', 'sapling', modulus=9.0e9, density=900.0, damping_in_leaf=0.10)
LEAF_MASS, LEAF_AREA = 0.0009, 0.0060


@pytest.fixture(scope='module')
def sapling():
    """Draw a stem of 1.6 m with twelve petioles of 9 cm by 1.8 mm, each for a leaf."""
    drawn = Sketch()
    drawn.add(None, 0, UP, 1.6, 0.012, 0.004, 12)
    for leaf in range(12):
        turn = 2.4 * leaf
        away = np.cos(turn), np.sin(turn), 0.5
        drawn.add(0, 4 + 9 * leaf // 12, away, 0.09, 0.0018, 0.0018, 3)
    return drawn.tree()


def simulator(tree, model):
    on_petioles = np.ones(tree.n_branches)
    on_petioles[0] = 0.0
    return make_simulator(
        tree, WOOD, model=model, in_leaf=True, cache=None,
        leaf_mass=LEAF_MASS * on_petioles, leaf_area=LEAF_AREA * on_petioles,
    )  # fmt: skip


@pytest.mark.parametrize('dt', [1.0 / 240.0, 1.0 / 60.0, 1.0 / 25.0, 0.2])
def test_the_rate_at_the_middle_of_a_step_follows_the_force(sapling, dt):
    modal = simulator(sapling, 60).banks[0].oscillators.modal
    _, half = step_propagators(modal.damping, modal.stiffness, dt)
    assert (half[1, 2] > 0.0).all()


def test_a_coordinate_that_is_resolved_gets_to_the_middle_exactly(sapling):
    modal = simulator(sapling, 12).banks[0].oscillators.modal
    half = step_propagators(modal.damping, modal.stiffness, 1e-3)[1].reshape(6, -1)
    exact = propagator(1.0, modal.damping, modal.stiffness, 0.5e-3).T
    assert half[[0, 1, 3, 4]] == pytest.approx(exact[[0, 1, 4, 5]], rel=1e-12)
    assert half[[2, 5]] == pytest.approx(exact[[2, 6]] + exact[[3, 7]], rel=1e-12)
