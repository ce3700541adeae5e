# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A tree's shape in a few coordinates."""

from __future__ import annotations

from functools import cache
import subprocess
import sys

import numpy as np
import pytest

from tree_sway.core.growth.builtin import builtin_tree
from tree_sway.core.model.state_basis import FULL_SCALE
from tree_sway.core.run.find_basis import state_basis, tip_moments
from tree_sway.core.scene.make import make_simulator
from tree_sway.core.setup.tree_motion import tip_motion
from tree_sway.core.wind.simulated.turbulence import simulate_turbulence
from tree_sway.stream.protocol import quantised

DT = 1.0 / 60.0


@cache
def with_basis(name):
    """Make a tree that sways, and its basis; once."""
    sim = make_simulator(builtin_tree(name), model=60)
    return sim, state_basis(sim)


@pytest.fixture
def benjamina():
    return with_basis('benjamina')[0]


@pytest.fixture
def basis():
    return with_basis('benjamina')[1]


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
            x = basis.rotations(basis.rounded(basis.coordinates(sim.rotations())))
            placed.append(sim.place()[:, :3].copy())
            through.append(sim.place_rotations(x)[:, :3])
    placed, through = np.array(placed), np.array(through)
    return np.linalg.norm(placed - through, axis=2), placed - placed.mean(axis=0)


@pytest.mark.parametrize('name', ['benjamina', 'goldcrest'])
@pytest.mark.parametrize('speed', [2.0, 9.0, 15.0])
def test_no_segment_is_farther_off_than_the_error_that_is_reported(name, speed):
    sim, basis = with_basis(name)
    gap, motion = gaps(sim, basis, speed)
    assert gap.max() <= basis.error
    assert np.sqrt(np.square(motion).sum(axis=2).mean()) > 5.0 * np.sqrt(np.square(gap).mean())


def test_a_storm_beyond_the_reported_error_is_flagged_and_a_breeze_is_not(benjamina, basis):
    for speed, is_beyond in ((6.0, False), (30.0, True)):
        rng, flags = np.random.default_rng(2), []
        benjamina.reset()
        for wind in simulate_turbulence(speed, rate=60.0, duration=4.0, rng=rng):
            benjamina.step(wind, DT)
            flags.append(quantised(basis.coordinates(benjamina.rotations()), basis.scale)[1])
        assert any(flags) == is_beyond


def test_coordinates_of_a_shape_in_the_basis_are_its_own(basis):
    coordinates = np.random.default_rng(1).normal(size=basis.n_coordinates) * basis.scale / 10.0
    again = basis.coordinates(basis.rotations(coordinates))
    assert again == pytest.approx(coordinates, rel=1e-9, abs=1e-9 * basis.scale.max())


def test_what_is_beyond_full_scale_is_held(basis):
    coordinates = basis.scale * np.linspace(-2.0, 2.0, basis.n_coordinates)
    sent = basis.rounded(coordinates)
    clamped = np.abs(coordinates) > basis.scale
    np.testing.assert_allclose(np.abs(sent[clamped]), basis.scale[clamped])
    finest = basis.scale.max() / FULL_SCALE
    np.testing.assert_allclose(sent[~clamped], coordinates[~clamped], atol=finest)


def test_forces_on_tips_do_the_work_that_moments_do(fork):
    joints = make_simulator(fork(), model='full', enrich='all').banks[0].branches
    rng = np.random.default_rng(3)
    x = rng.normal(size=(int(joints['n_coordinates'].sum()), 4))
    forces = rng.normal(size=(len(joints), 3, 5))
    work = np.einsum('bik,bil->kl', tip_motion(joints, x), forces)
    assert x.T @ tip_moments(joints, forces) == pytest.approx(work, rel=1e-12)


def test_a_tree_without_motion_has_a_basis(fork):
    basis = state_basis(make_simulator(fork(), model=0))
    assert (basis.rotations(basis.coordinates(np.zeros(len(basis.matrix)))) == 0.0).all()


def test_the_simulator_is_left_as_it_was(fork):
    sim = make_simulator(fork(), model='branch')
    sim.step((4.0, 1.0, 0.0), DT)
    before = sim.state().values.tobytes()
    state_basis(sim)
    assert sim.state().values.tobytes() == before


PROGRAM = """
import hashlib
import numpy as np
from tree_sway.core.growth.builtin import builtin_tree
from tree_sway.core.run.simulator import SwaySimulator
from tree_sway.core.scene.make import make_simulator
from tree_sway.core.run.find_basis import state_basis
sim = make_simulator(builtin_tree("goldcrest"), model=60)
basis = state_basis(sim)
coordinates = np.linspace(-0.1, 0.1, basis.n_coordinates) * basis.scale
poses = sim.place_rotations(basis.rotations(coordinates))
print(basis.digest, hashlib.sha256(poses.tobytes()).hexdigest())
"""


def test_two_processes_find_the_same_bits(capsys):
    done = subprocess.run(
        [sys.executable, '-c', PROGRAM], capture_output=True, text=True, check=True
    )
    exec(PROGRAM, {})
    here = capsys.readouterr().out
    assert here == done.stdout
    assert len(here.split()) == 2
