# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Natural modes as oscillators: exact decay, static correction of the others, loads clamped."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.sparse.linalg import spsolve
from tree_sway_lab.full.bank import Air

from tree_sway.core.run.assembly import bank_of
from tree_sway.core.settings import Settings
from tree_sway.core.setup.beams.branch_model import TreeBeams
from tree_sway.core.setup.matrices import reduce_tree
from tree_sway.core.setup.preparation import prepare
from tree_sway.core.species.species import species_named

WOOD = species_named('broadleaf')
DRAG = 0.5 * 1.225 * WOOD.drag_coefficient
DT = 1 / 120


def modal(tree, **changes):
    chosen = {'model': 'full', 'gravity': 0.0, 'enrich': 'none'} | changes
    bank = bank_of(prepare(tree, WOOD, Settings(**chosen))).oscillators
    bank.set_step(DT)
    return bank


def stiffness_of(tree):
    models = TreeBeams(tree, WOOD.density, shear_ratio=WOOD.shear_ratio).models(subtrees=True)
    return reduce_tree(tree, models, WOOD.modulus, WOOD.shear_ratio * WOOD.modulus, 0.0).stiffness


def test_each_mode_decays_as_an_oscillator_of_its_own(fork):
    bank = modal(fork(), damping_ratio=0.05)
    bank.modal[0] = 1e-7
    for _ in range(240):
        bank.advance_in(Air(0.0, 0.0, 0.0, DRAG))
    w, t = np.sqrt(bank.stiffness), 240 * DT
    wd = w * np.sqrt(1 - 0.05**2)
    exact = np.exp(-0.05 * w * t) * (np.cos(wd * t) + 0.05 * w / wd * np.sin(wd * t))
    assert bank.modal[0] / 1e-7 == pytest.approx(exact, abs=1e-3)


def test_steady_wind_gives_the_static_answer(fork):
    tree = fork()
    bank = modal(tree, damping_ratio=0.7)
    for _ in range(3000):
        bank.advance_in(Air(1.0, 0.5, 0.2, DRAG))
    x, moment = bank.rotations().copy(), bank.state[0].copy()
    truth = spsolve(stiffness_of(tree), moment)
    assert np.abs(x - truth).max() < 1e-6 * np.abs(truth).max()


def test_no_motion_without_load(fork):
    bank = modal(fork())
    for _ in range(20):
        assert bank.advance_in(Air(0.0, 0.0, 0.0, DRAG)) == 0
    assert not bank.rotations().any()


def test_moments_beyond_the_limit_are_held_and_counted(fork):
    bank = modal(fork(), model='full')
    assert bank.advance_in(Air(5.0, 2.0, 0.0, DRAG)) == 0
    assert sum(bank.advance_in(Air(5.0, 2.0, 0.0, 1e12)) for _ in range(300)) > 0
    assert np.isfinite(bank.rotations()).all()


def test_a_step_whose_load_is_not_found_is_counted(fork):
    bank = modal(fork())
    assert bank.advance_in(Air(8.0, 0.0, 0.0, DRAG)) == 0
    bank._enough[0] = 0.0  # no change of the load is small enough
    assert bank.advance_in(Air(8.0, 0.0, 0.0, DRAG)) == 1


def test_compliance_is_the_answer_to_a_unit_of_force(fork):
    """What the bank says a force on a load centre does half a step on, tried on its modes."""
    tree = fork()
    bank = modal(tree, model='full')
    branches, shapes = bank.branches, bank.shapes
    b = 3
    own = slice(branches['coordinate'][b], branches['coordinate'][b] + 2)
    stem = slice(0, 2)
    total = 0.0
    for way in np.eye(3):
        twist = branches['twist'][b, :2]
        at = twist[:, :3] + np.cross(twist[:, 3:], branches['centre'][b])
        moment = np.zeros(len(shapes))
        moment[stem] = at @ way
        moment[own] = branches['damping_mode'][b, :2] @ way
        force = shapes.T @ moment
        half = 0.5 * DT
        # A mode under a constant force from rest, by its own text-book answer.
        w, z = np.sqrt(bank.stiffness), bank.damping / (2.0 * np.sqrt(bank.stiffness))
        wd = w * np.sqrt(1 - z**2)
        rate = np.exp(-z * w * half) * np.sin(wd * half) / wd * force
        total += moment @ (shapes @ rate)
    assert bank.loads['compliance'][0, b] == pytest.approx(total / 2.0, rel=1e-9)


def test_reset_forgets_everything(fork):
    bank, fresh = modal(fork()), modal(fork())
    for k in range(20):
        bank.advance_in(Air(9.0, 1.0 * k, 0.0, DRAG))
    bank.reset()
    for _ in range(5):
        for one in (bank, fresh):
            one.advance_in(Air(3.0, 1.0, 0.0, DRAG))
    assert bank.rotations().tobytes() == fresh.rotations().tobytes()
