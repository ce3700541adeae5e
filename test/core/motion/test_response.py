# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The linear answer of every model against the same model stepped in light wind."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from tree_sway_ros.core.motion.drag import pressure
from tree_sway_ros.core.motion.numpy_passes import mean_wind_moments
from tree_sway_ros.core.motion.response import key_response, tip_motion
from tree_sway_ros.core.reference.measure import tips_of_poses
from tree_sway_ros.core.simulator.assembly import CalibratedTree
from tree_sway_ros.core.simulator.settings import Settings
from tree_sway_ros.core.simulator.simulator import SwaySimulator
from tree_sway_ros.core.tree.species import species_named

OAK = species_named('oak')
MODELS = ('branch', 'subtree', 'modes', 'coupled')
DAMPED = Settings(gravity=0.0, damping_ratio=0.2, n_modes=8)
LIGHT = 0.3


@pytest.fixture(scope='module')
def bank_of(fork):
    calibrated = CalibratedTree(fork(), OAK, DAMPED)
    return cache(lambda model: calibrated.bank(model, 8))


def count(bank):
    return int((bank.branches['coordinate'] + bank.branches['n_coordinates']).max())


def at_rest(bank):
    """Find the static rotations under the mean of winds from all sides."""
    moments = mean_wind_moments(bank.branches, count(bank))
    return bank.oscillators.response(moments, np.zeros(1))


def answer(bank, frequencies):
    turned = key_response(bank.oscillators, count(bank), np.asarray(frequencies, dtype=float))
    return tip_motion(bank.oscillators.branches, turned)


def load_of(speed):
    return pressure(speed, *OAK.drag_law(False)) * speed**2


def displaced(sim, tree):
    return tips_of_poses(tree, sim.place()) - tree.end[tree.branch_first[1:] - 1]


@pytest.mark.parametrize('way', [0, 1])
@pytest.mark.parametrize('model', MODELS)
def test_static_answer_is_where_steady_wind_leaves_the_tips(fork, bank_of, model, way):
    tree = fork()
    sim = SwaySimulator(tree, OAK, DAMPED, model=model)
    for _ in range(1500):
        sim.step(LIGHT * np.eye(3)[way], 1 / 60)
    expected = answer(bank_of(model), [0.0])[:, :, way, 0]
    assert not expected.imag.any()
    size = np.abs(expected.real).max() * load_of(LIGHT)
    assert displaced(sim, tree) == pytest.approx(expected.real * load_of(LIGHT), abs=5e-3 * size)


@pytest.mark.parametrize('share', [0.5, 1.0, 1.6])
@pytest.mark.parametrize('model', MODELS)
def test_a_load_that_swings_moves_the_tips_as_the_response_says(fork, bank_of, model, share):
    tree, bank = fork(), bank_of(model)
    sim = SwaySimulator(tree, OAK, DAMPED, model=model)
    frequency = share * float(np.min(sim.frequencies()))
    per_turn, settle, turns = 120, 12, 2
    phase, tips = [], []
    for k in range(per_turn * (settle + turns)):
        middle = 2.0 * np.pi * (k + 0.5) / per_turn
        speed = LIGHT * np.sqrt(1.0 + 0.5 * np.cos(middle))  # the load then swings as a cosine
        sim.step([speed, 0.0, 0.0], 1.0 / (per_turn * frequency))
        if k >= per_turn * settle:
            phase.append(2.0 * np.pi * (k + 1.0) / per_turn)
            tips.append(displaced(sim, tree))
    found = 2.0 * np.tensordot(np.exp(-1j * np.array(phase)), np.array(tips), axes=1) / len(phase)
    expected = answer(bank, [frequency])[:, :, 0, 0] * 0.5 * load_of(LIGHT)
    assert found == pytest.approx(expected, abs=0.05 * np.abs(expected).max())


def test_a_frozen_tree_answers_nothing(bank_of):
    assert not answer(bank_of('frozen'), [0.0, 1.0]).any()


@pytest.mark.parametrize('model', ['branch', 'subtree', 'coupled'])
def test_fast_loads_move_inertia_alone(bank_of, model):
    """Far above all modes the answer falls with the square of the frequency."""
    slow, fast, faster = np.moveaxis(answer(bank_of(model), [0.0, 4e4, 8e4]), -1, 0)
    assert np.abs(fast).max() < 1e-4 * np.abs(slow).max()
    assert fast == pytest.approx(4.0 * faster, abs=0.05 * np.abs(fast).max())


def test_modes_left_out_answer_at_once(bank_of):
    """
    Truncation keeps the modes' static share: exact at rest, far above those that stay.

    The wind is from any side, and its load linear.
    """
    rests = [at_rest(bank_of(model)) for model in ('modes', 'coupled')]
    assert rests[0] == pytest.approx(rests[1], abs=1e-9 * np.abs(rests[1]).max())
    modes, coupled = (answer(bank_of(model), [0.0, 4e4, 8e4]) for model in ('modes', 'coupled'))
    assert modes[..., 0] == pytest.approx(coupled[..., 0], abs=1e-3 * np.abs(coupled).max())
    assert modes[..., 1] == pytest.approx(modes[..., 2], abs=1e-6 * np.abs(modes).max())
    assert np.abs(modes[..., 2]).max() > 1e-3 * np.abs(coupled[..., 0]).max()


def test_small_rotations_are_joined_from_the_root(bank_of):
    """On its own, a turn of the stem carries all that sits on it as a rigid body at its seat."""
    bank = bank_of('coupled')
    branches, stem = bank.branches, bank.branches[0]
    for c in range(int(stem['n_coordinates'])):
        rotations = np.zeros(count(bank))
        rotations[stem['coordinate'] + c] = 0.1
        tips = tip_motion(branches, rotations)
        assert tips[0] == pytest.approx(0.1 * stem['reach'][c])
        for b in range(1, len(branches)):
            limb = b
            while branches[limb]['parent'] > 0:
                limb = branches[limb]['parent']
            linear, angular = np.split(branches[limb]['twist'][c], 2)
            carried = linear + np.cross(angular, branches[b]['tip'])
            assert tips[b] == pytest.approx(0.1 * carried, abs=1e-14)


def test_motion_is_linear_in_the_rotations_and_in_every_column(bank_of):
    bank, rng = bank_of('subtree'), np.random.default_rng(0)
    many = rng.normal(size=(count(bank), 2, 3)) + 1j * rng.normal(size=(count(bank), 2, 3))
    whole = tip_motion(bank.branches, many)
    assert whole.shape == (len(bank.branches), 3, 2, 3)
    for i, j in np.ndindex(2, 3):
        column = tip_motion(bank.branches, many[:, i, j])
        assert whole[..., i, j] == pytest.approx(column)
    assert tip_motion(bank.branches, many.real) == pytest.approx(whole.real)
