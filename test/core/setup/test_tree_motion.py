# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Small rotations joined from the root."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from tree_sway.core.run import assembly
from tree_sway.core.settings import Settings
from tree_sway.core.setup.preparation import prepare
from tree_sway.core.setup.tree_motion import branch_rotations, tip_motion
from tree_sway.core.species.species import species_named

OAK = species_named('oak')
DAMPED = Settings(gravity=0.0, damping_ratio=0.2)


@pytest.fixture(scope='module')
def bank_of(fork):
    return cache(lambda model: assembly.bank_of(prepare(fork(), OAK, DAMPED, model=model)))


def count(bank):
    return int((bank.branches['coordinate'] + bank.branches['n_coordinates']).max())


def test_small_rotations_are_joined_from_the_root(bank_of):
    """On its own, a turn of the stem carries all that sits on it as a rigid body at its seat."""
    bank = bank_of(12)
    branches, stem = bank.branches, bank.branches[0]
    for c in range(int(stem['n_coordinates'])):
        rotations = np.zeros(count(bank))
        rotations[stem['coordinate'] + c] = 0.1
        tips = tip_motion(branches, rotations)
        assert tips[0] == pytest.approx(0.1 * stem['tip_mode'][c])
        for b in range(1, len(branches)):
            limb = b
            while branches[limb]['parent'] > 0:
                limb = branches[limb]['parent']
            linear, angular = np.split(branches[limb]['twist'][c], 2)
            carried = linear + np.cross(angular, branches[b]['tip'])
            assert tips[b] == pytest.approx(0.1 * carried, abs=1e-14)


def test_motion_is_linear_in_the_rotations_and_in_every_column(bank_of):
    bank, rng = bank_of(12), np.random.default_rng(0)
    many = rng.normal(size=(count(bank), 2, 3)) + 1j * rng.normal(size=(count(bank), 2, 3))
    whole = tip_motion(bank.branches, many)
    assert whole.shape == (len(bank.branches), 3, 2, 3)
    for i, j in np.ndindex(2, 3):
        column = tip_motion(bank.branches, many[:, i, j])
        assert whole[..., i, j] == pytest.approx(column)
    assert tip_motion(bank.branches, many.real) == pytest.approx(whole.real)


def test_a_branch_turns_with_all_that_it_hangs_on(bank_of):
    bank = bank_of(12)
    rotations = np.zeros(count(bank))
    rotations[0] = 0.1
    turns = branch_rotations(bank.branches, rotations)
    assert turns[0] == pytest.approx(0.1 * bank.branches['load_rotation'][0, 0])
    for b in range(1, len(bank.branches)):
        limb = b
        while bank.branches[limb]['parent'] > 0:
            limb = bank.branches[limb]['parent']
        assert turns[b] == pytest.approx(0.1 * bank.branches['twist'][limb, 0, 3:])
