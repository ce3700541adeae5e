# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A tree's shape in a few coordinates."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest

from tree_sway_ros.core.growth.builtin import builtin_tree
from tree_sway_ros.core.motion.response import tip_motion
from tree_sway_ros.core.simulator.simulator import SwaySimulator
from tree_sway_ros.core.state.find_basis import state_basis, tip_moments
from tree_sway_ros.core.state.full_scale import FULL_SCALE
from tree_sway_ros.core.wind.simulated.turbulence import simulate_turbulence
from tree_sway_ros.errors import ParameterError

DT = 1.0 / 60.0


@pytest.fixture(scope='module')
def benjamina():
    return SwaySimulator(builtin_tree('benjamina'), model='modes')


@pytest.fixture(scope='module')
def basis(benjamina):
    return state_basis(benjamina, 16)


def gaps(sim, basis, speed, steps=600):
    """Gaps of segments behind the model, and their motion, both about the mean, in [m]."""
    rng = np.random.default_rng(5)
    placed, through = [], []
    sim.reset()
    for number, wind in enumerate(
        simulate_turbulence(speed, rate=60.0, duration=steps * DT, rng=rng)
    ):
        sim.step(wind, DT)
        if number % 10 == 9:
            steps16, held = basis.quantised(basis.coordinates(sim.rotations()))
            assert not held
            x = basis.rotations(basis.from_quantised(steps16))
            placed.append(sim.place()[:, :3].copy())
            through.append(sim.place_rotations(x)[:, :3])
    placed, through = np.array(placed), np.array(through)
    return np.linalg.norm(placed - through, axis=2), placed - placed.mean(axis=0)


@pytest.fixture(scope='module')
def fine_basis(benjamina):
    return state_basis(benjamina, 38)


def test_thirty_eight_coordinates_hold_the_modes_and_their_static_rest(benjamina, fine_basis):
    assert len(benjamina.bank.frequencies) == 23
    gap, motion = gaps(benjamina, fine_basis, 2.0)
    assert 1.5e-3 < np.sqrt(np.square(motion).sum(axis=2).mean())
    assert gap.max() <= 1e-4


def test_the_error_that_is_told_is_one_in_a_storm(benjamina, fine_basis):
    basis = fine_basis
    gap, _ = gaps(benjamina, basis, 12.0)
    assert np.sqrt(np.square(gap).mean()) <= 2.0 * basis.error.quantised_rms
    assert gap.max() <= 2.0 * basis.error.quantised_greatest
    assert basis.error.rms <= 0.004 * basis.error.motion_rms
    assert basis.error.quantised_rms <= 1.05 * basis.error.rms


def test_coordinates_of_a_shape_in_the_basis_are_its_own(basis):
    coordinates = np.random.default_rng(1).normal(size=16) * basis.scale / 10.0
    again = basis.coordinates(basis.rotations(coordinates))
    assert again == pytest.approx(coordinates, rel=1e-9, abs=1e-9 * basis.scale.max())


def test_what_is_beyond_full_scale_is_held_and_counted(basis):
    steps, held = basis.quantised(basis.scale * np.linspace(-2.0, 2.0, 16))
    assert held == 8
    assert (steps[0], steps[-1]) == (-FULL_SCALE, FULL_SCALE)
    assert basis.from_quantised(steps)[0] == pytest.approx(-basis.scale[0])


def test_forces_on_tips_do_the_work_that_moments_do(fork):
    joints = SwaySimulator(fork(), model='coupled', enrich='all').joints
    rng = np.random.default_rng(3)
    x = rng.normal(size=(int(joints['n_coordinates'].sum()), 4))
    forces = rng.normal(size=(len(joints), 3, 5))
    work = np.einsum('bik,bil->kl', tip_motion(joints, x), forces)
    assert x.T @ tip_moments(joints, forces) == pytest.approx(work, rel=1e-12)


def test_a_tree_that_stands_still_has_a_basis(fork):
    basis = state_basis(SwaySimulator(fork(), model='frozen'))
    assert (basis.rotations(basis.coordinates(np.zeros(len(basis.matrix)))) == 0.0).all()


def test_the_simulator_is_left_as_it_was(fork):
    sim = SwaySimulator(fork(), model='branch')
    sim.step((4.0, 1.0, 0.0), DT)
    before = sim.state().values.tobytes()
    state_basis(sim)
    assert sim.state().values.tobytes() == before


def test_no_coordinates_are_refused(fork):
    with pytest.raises(ParameterError, match='0 coordinates'):
        state_basis(SwaySimulator(fork()), 0)


PROGRAM = """
import hashlib
import numpy as np
from tree_sway_ros.core.growth.builtin import builtin_tree
from tree_sway_ros.core.simulator.simulator import SwaySimulator
from tree_sway_ros.core.state.find_basis import state_basis
sim = SwaySimulator(builtin_tree("goldcrest"), model="modes")
basis = state_basis(sim, 16)
coordinates = np.linspace(-0.1, 0.1, 16) * basis.scale
poses = sim.place_rotations(basis.rotations(coordinates))
print(basis.digest, hashlib.sha256(poses.tobytes()).hexdigest())
"""


def test_two_processes_find_the_same_bits():
    told = {
        subprocess.run(
            [sys.executable, '-c', PROGRAM], capture_output=True, text=True, check=True
        ).stdout
        for _ in range(2)
    }
    assert len(told) == 1
    assert len(told.pop().split()) == 2
