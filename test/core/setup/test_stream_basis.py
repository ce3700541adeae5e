# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The basis of the stream: the shape of a tree in a few coordinates."""

from __future__ import annotations

from functools import cache
import subprocess
import sys

from drawn_trees import crown
import numpy as np
import pytest
from scipy import linalg
from simulators import AUTO, FULL

from tree_sway.core.model.state_basis import FULL_SCALE, rounded
from tree_sway.core.run.simulator_basis import basis_of
from tree_sway.core.scene.make import make_simulator
from tree_sway.core.setup.leaning_responses import leaning_responses, N_FREQUENCIES
from tree_sway.core.setup.stream_basis import COUNTS, LEFT_OUT, principal_components
from tree_sway.core.setup.tree_motion import tip_moments, tip_motion
from tree_sway.core.wind.turbulence import simulate_turbulence
from tree_sway.growth.builtin import builtin_tree

DT = 1.0 / 60.0


@cache
def with_basis(name):
    """Make a tree that sways, and its basis; once."""
    sim = make_simulator(builtin_tree(name), model=60)
    return sim, basis_of(sim)


@pytest.fixture
def basis():
    return with_basis('goldcrest')[1]


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
            x = basis.rotations(rounded(basis.coordinates(sim.rotations()), basis.scale))
            placed.append(sim.place()[:, :3].copy())
            through.append(sim.place_rotations(x)[:, :3])
    placed, through = np.array(placed), np.array(through)
    return np.linalg.norm(placed - through, axis=2), placed - placed.mean(axis=0)


@pytest.mark.parametrize('name', ['goldcrest', pytest.param('benjamina', marks=pytest.mark.long)])
@pytest.mark.parametrize('speed', [2.0, 9.0, 15.0])
def test_no_segment_is_farther_off_than_the_error_that_is_reported(name, speed):
    sim, basis = with_basis(name)
    gap, motion = gaps(sim, basis, speed)
    assert gap.max() <= basis.error
    assert np.sqrt(np.square(motion).sum(axis=2).mean()) > 5.0 * np.sqrt(np.square(gap).mean())


def test_coordinates_of_a_shape_in_the_basis_are_its_own(basis):
    coordinates = np.random.default_rng(1).normal(size=basis.n_coordinates) * basis.scale / 10.0
    again = basis.coordinates(basis.rotations(coordinates))
    assert again == pytest.approx(coordinates, rel=1e-9, abs=1e-9 * basis.scale.max())


def test_what_is_beyond_full_scale_is_held(basis):
    coordinates = basis.scale * np.linspace(-2.0, 2.0, basis.n_coordinates)
    sent = rounded(coordinates, basis.scale)
    clamped = np.abs(coordinates) > basis.scale
    np.testing.assert_allclose(np.abs(sent[clamped]), basis.scale[clamped])
    finest = basis.scale.max() / FULL_SCALE
    np.testing.assert_allclose(sent[~clamped], coordinates[~clamped], atol=finest)


def test_forces_on_tips_do_the_work_that_moments_do(fork):
    joints = make_simulator(fork(), model=60, enrich='all').banks[0].branches
    rng = np.random.default_rng(3)
    x = rng.normal(size=(int(joints['n_coordinates'].sum()), 4))
    forces = rng.normal(size=(len(joints), 3, 5))
    work = np.einsum('bik,bil->kl', tip_motion(joints, x), forces)
    assert x.T @ tip_moments(joints, forces) == pytest.approx(work, rel=1e-12)


def test_principal_components_are_those_of_the_singular_values():
    """Against scipy's singular value decomposition of the motion of the tips."""
    rng = np.random.default_rng(4)
    tips = rng.normal(size=(90, 40)) * np.geomspace(1.0, 1e-3, 40)
    motions = rng.normal(size=(40, 200)) * np.geomspace(1.0, 1e-3, 200)
    shapes, projection = principal_components(tips.T @ tips, motions)
    ways, sizes, _ = linalg.svd(tips @ motions)
    count = shapes.shape[1]
    assert count in COUNTS
    left_out = np.sqrt(1.0 - np.cumsum(sizes**2) / np.sum(sizes**2))
    assert left_out[count - 1] <= LEFT_OUT < left_out[count - 5]
    assert projection @ shapes == pytest.approx(np.eye(count), abs=1e-9)
    found, wanted = tips @ shapes, ways[:, :count]
    assert np.abs((found * wanted).sum(axis=0)) == pytest.approx(np.ones(count), abs=1e-6)


def test_motions_that_are_too_many_for_a_frame_take_the_most_that_it_has():
    shapes, _ = principal_components(np.eye(50), np.eye(50))
    assert shapes.shape == (50, COUNTS[-1])


@pytest.mark.parametrize('model', ['branch', *AUTO, 12, *FULL])
def test_the_motion_of_every_model_is_streamed(model):
    sim = make_simulator(crown((5, 3)), model=model)
    gap, motion = gaps(sim, basis_of(sim), 9.0)
    assert np.sqrt(np.square(gap).mean()) < 0.01 * np.sqrt(np.square(motion).sum(axis=2).mean())


@pytest.mark.parametrize(('what', 'component'), [('along', 0), ('across', 1), ('up', 2)])
def test_gusts_move_a_leaning_tree_as_they_do_when_it_is_stepped(what, component):
    """Small gusts of one frequency on a steady wind of 13 m/s, stepped until they repeat."""
    speed, azimuth = 13.0, 4  # of 24: 60 degrees
    sim = make_simulator(crown(), model=12)
    bank = sim.banks[0].oscillators
    stiffness, damping = bank.modal.stiffness, bank.modal.damping
    leaning = next(
        leaning_responses(
            sim.models[0].arrays(), stiffness, damping, sim.models[0].drag_law, (speed,)
        )
    )
    slowest, fastest = np.sqrt([stiffness.min(), stiffness.max()])
    swept = np.geomspace(slowest / 1.5, 1.5 * fastest, N_FREQUENCIES)
    spectrum = np.maximum(swept, slowest) ** (-1.0 / 3.0)
    amplitude = spectrum / np.linalg.norm(spectrum) * 0.25 * (1.0, 0.8, 0.5)[component]
    n_frequency, gust, dt = 6, 0.01 * speed, 1.0 / 120.0
    expected = leaning.gusts[azimuth, n_frequency, :, component] / amplitude[n_frequency]
    angle = np.pi / 3.0
    ways = (np.cos(angle), np.sin(angle), 0.0), (-np.sin(angle), np.cos(angle), 0.0), (0, 0, 1.0)
    steady, beside = speed * np.array(ways[0]), gust * np.array(ways[component])
    period = 2.0 * np.pi / swept[n_frequency]
    steps = round(40.0 * period / dt)
    phase = swept[n_frequency] * dt * (np.arange(steps) + 0.5)
    found = np.zeros((steps, 12))
    for step, now in enumerate(np.cos(phase)):
        sim.step(steady + now * beside, dt)
        found[step] = bank.swing[0]
    last = slice(-round(10.0 * period / dt), None)
    wave = np.exp(1j * swept[n_frequency] * dt * (np.arange(steps) + 1.0))[last]
    moved = found[last] - found[last].mean(axis=0)
    response = 2.0 * (wave.conj() @ moved) / len(wave) / (gust / speed)
    root = np.sqrt(stiffness)  # by the energy of the coordinates
    apart = np.linalg.norm(root * (response - expected)) / np.linalg.norm(root * response)
    assert apart < 0.1, what


def test_a_tree_without_motion_has_a_basis(fork):
    basis = basis_of(make_simulator(fork(), model=0))
    assert (basis.rotations(basis.coordinates(np.zeros(len(basis.matrix)))) == 0.0).all()


def test_the_simulator_is_left_as_it_was(fork):
    sim = make_simulator(fork(), model='branch')
    sim.step((4.0, 1.0, 0.0), DT)
    before = sim.state().values.tobytes()
    assert basis_of(sim).n_coordinates > 0
    assert sim.state().values.tobytes() == before


PROGRAM = """
import hashlib
import numpy as np
from tree_sway.core.run.simulator_basis import basis_of
from tree_sway.growth.builtin import builtin_tree
from tree_sway.core.scene.make import make_simulator
sim = make_simulator(builtin_tree("goldcrest"), model=60)
basis = basis_of(sim)
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
