# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Inertia and weight of the bent tree against kinetic energy and potential of its poses."""

import numpy as np
import pytest

from tree_sway.core.motion.bent_tree import inertia_change, MOST_CHANGE
from tree_sway.core.simulator import assembly
from tree_sway.core.simulator.reductions import TreeReductions
from tree_sway.core.simulator.settings import Settings
from tree_sway.core.simulator.simulator import SwaySimulator
from tree_sway.core.tree.segment_frame import ends_of_poses
from tree_sway.core.tree.species import species_named

pytestmark = pytest.mark.compiled

GRAVITY, COUNT = 9.81, 12


@pytest.fixture(scope='module')
def made(fork):
    """Return a bent tree, its coordinates, and the simulator that places it."""
    settings, found = Settings(model=20, gravity=GRAVITY, in_leaf=False), {}
    patch = pytest.MonkeyPatch()
    with patch.context() as context:
        table = assembly._table

        def listen(reductions, laid):
            made = table(reductions, laid)
            found['bent'], found['modal'] = made._bent, laid.oscillators
            return made

        context.setattr(assembly, '_table', listen)
        sim = SwaySimulator(fork(), settings=settings, cache=None)
    return found['bent'], found['modal'], sim


def middles(sim, x):
    return ends_of_poses(sim.place_rotations(x), 0.5 * sim.tree.length)[1]


def mass(sim):
    return sim.species.density * sim.tree.volume


def energy(sim, shapes, at, rates):
    """Twice the kinetic energy of the middles of the segments, by their places a moment apart."""
    h = 1e-4
    ahead, behind = (middles(sim, shapes @ (at + s * h * rates)) for s in (1.0, -1.0))
    return float(mass(sim) @ np.square((ahead - behind) / (2.0 * h)).sum(axis=1))


def some_pose(modal, turn=0.5):
    """Coordinates that rotate the branches by up to an angle [rad]."""
    at = np.random.default_rng(3).standard_normal(modal.shapes.shape[1])
    at[3:] *= 0.1
    return at * turn / np.abs(modal.shapes @ at).max()


def test_at_rest_nothing_changes(made):
    bent, modal, _ = made
    none = np.zeros(modal.shapes.shape[1])
    assert np.abs(inertia_change(bent.inertia_slopes, none)).max() == 0.0
    assert np.abs(bent.weight(none)).max() == 0.0


def test_the_inertia_is_that_of_the_kinetic_energy(made):
    bent, modal, sim = made
    at = some_pose(modal, turn=0.2)
    added = inertia_change(bent.inertia_slopes, at)
    assert np.linalg.norm(added, 2) > 0.02
    count = len(added)
    rng, none = np.random.default_rng(4), np.zeros(len(at))
    for _ in range(5):
        rates = none.copy()
        rates[:count] = lead = rng.standard_normal(count)
        change = energy(sim, modal.shapes, at, rates) - energy(sim, modal.shapes, none, rates)
        assert lead @ added @ lead == pytest.approx(change, abs=5e-3 * lead @ lead)


def test_a_change_of_the_inertia_is_bounded(made):
    bent, modal, _ = made
    far = inertia_change(bent.inertia_slopes, 50.0 * some_pose(modal))
    assert np.linalg.norm(far) == pytest.approx(MOST_CHANGE)


def test_the_weight_is_the_slope_of_its_potential(made):
    bent, modal, sim = made

    def potential(coordinates):
        return GRAVITY * float(mass(sim) @ middles(sim, modal.shapes @ coordinates)[:, 2])

    def slope(at):
        h = 1e-4 / np.abs(modal.shapes).max(axis=0)
        steps = np.diag(h)[:COUNT]
        return np.array([
            (potential(at + step) - potential(at - step)) / (2.0 * step.max()) for step in steps
        ])  # fmt: skip

    at = some_pose(modal)
    small = 1e-2 * at
    linear = (slope(small) - slope(-small)) / 2e-2
    expected = slope(0.0 * at) + linear - slope(at)
    force = bent.weight(at)
    assert np.abs(force[COUNT:]).max(initial=0.0) == 0.0
    np.testing.assert_allclose(force[:COUNT], expected, atol=0.03 * np.abs(expected).max())
    assert np.abs(expected).max() > 0.05 * np.abs(linear).max()


def test_without_gravity_there_is_no_weight(fork):
    reductions = TreeReductions(
        fork(), species_named('broadleaf'), Settings(model=20, gravity=0.0, in_leaf=False)
    )
    table = assembly.assembled(reductions).oscillators.table
    assert np.abs(table._bent.weight(np.ones(int(table.record['n_modes'][0])))).max() == 0.0
