# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The table of winds, compiled and in numpy: one law, step by step and over whole runs."""

from __future__ import annotations

import os
import subprocess
import sys

import numpy as np
import pytest
from tree_sway_lab.bench.bench_tree import bench_tree

from tree_sway.cache.kernel_cache import PLAIN_VARIABLE
from tree_sway.core.growth.builtin import builtin_tree
from tree_sway.core.kernel import WHY_PLAIN
from tree_sway.core.run import numpy_stand
from tree_sway.core.run.numpy_placing import NumpyPlacing
from tree_sway.core.run.placing import GIVEN, place, room_for
from tree_sway.core.run.stand import PLACEMENT, step_stand
from tree_sway.core.scene.make import make_simulator

FRAME = 1.0 / 60.0

pytestmark = pytest.mark.skipif(bool(WHY_PLAIN), reason=f'compares with kernels, and {WHY_PLAIN}')


@pytest.fixture(scope='module')
def pair():
    """Return the oscillators of a tree on its table, compiled, and in numpy on the same table."""
    from tree_sway.core.run.numpy_table import NumpyTableBank

    bank = make_simulator(bench_tree(), model=60).banks[0].oscillators
    return bank, NumpyTableBank(bank.modal, bank.table)


def random_state(bank, rng, size):
    """Return displacements, rates and forces whose energy is a share of the largest of winds."""
    table = bank.table[0]
    n_modes = int(table['n_modes'])
    stiffness = table['stiffness'][:n_modes]
    state = np.zeros((3, len(table['stiffness'])))
    state[:2, :n_modes] = rng.normal(size=(2, n_modes)) / np.arange(1.0, n_modes + 1.0)
    energy = stiffness @ state[0, :n_modes] ** 2 + (state[1] ** 2).sum()
    state[:2] *= np.sqrt(size * table['most_energy'] / energy)
    state[2, :n_modes] = stiffness * state[0, :n_modes]
    return state


@pytest.mark.parametrize(
    ('what', 'wind', 'size', 'left_out'),
    [
        ('a calm', (0.0, 0.0, 0.0), 0.01, 0),
        ('a breeze', (3.0, -2.0, 0.1), 0.01, 0),
        ('a gale', (-14.0, 9.0, 2.0), 0.3, 0),
        ('a wind along an azimuth of the table', (11.0, 0.0, 0.0), 0.1, 0),
        ('a wind from below', (1.0, 2.0, 9.0), 0.05, 0),
        ('a wind straight down', (0.0, 0.0, -12.0), 0.05, 0),
        ('coordinates that are left out', (8.0, 5.0, 7.0), 0.1, 25),
        ('a wind beyond the table', (120.0, 10.0, 0.0), 0.5, 0),
        ('a pull beyond the table', (10.0, 0.0, 0.0), 3.0, 0),
        ('motion that is not finite', (10.0, 0.0, 0.0), np.nan, 0),
    ],
)
def test_a_step_in_numpy_is_the_step_of_the_kernel(pair, what, wind, size, left_out):
    rng = np.random.default_rng(4)
    for bank in pair:
        bank.reset()
        bank.set_step(FRAME)
    for _ in range(20):
        state = random_state(pair[0], rng, size)
        found = []
        for bank in pair:
            for name, values in zip(('eta', 'rate', 'force'), state, strict=True):
                bank.instance[name][0] = values
            bank.instance['left_out'] = left_out
            found.append(bank.advance(*wind, 0.6))
        assert found[0] == found[1], what
        kernel, twin = (bank.instance[0] for bank in pair)
        assert kernel['outside'] == twin['outside']
        for name in ('eta', 'rate', 'force', 'wanted', 'diagonal', 'wind', 'drag_density'):
            # Products of single precision are summed in another order.
            scale = np.abs(kernel[name]).max()
            assert twin[name] == pytest.approx(
                kernel[name], rel=0.0, abs=3e-6 * scale, nan_ok=True
            )
    assert pair[0].n_outside == pair[1].n_outside


def test_key_rotations_are_those_of_the_kernel(pair):
    rng = np.random.default_rng(1)
    kernel, twin = pair
    m = kernel.shapes.shape[1]
    for bank in pair:
        bank.reset()
    kernel.instance['eta'][0, :m] = twin.instance['eta'][0, :m] = rng.normal(size=m)
    for bank in pair:
        bank.show(np.linspace(0.0, 0.1, m), 40)
    assert np.abs(kernel.rotations()).max() > 0.1
    assert twin.rotations() == pytest.approx(kernel.rotations(), abs=1e-5)


def test_a_step_of_a_stand_in_numpy_is_that_of_the_kernel(pair):
    rng = np.random.default_rng(7)
    bank, n_trees = pair[0], 6
    bank.set_step(FRAME)
    placements = np.zeros(n_trees, dtype=PLACEMENT)
    yaw = rng.uniform(0.0, 6.0, n_trees)
    placements['scale'], placements['speed'] = 1.0, rng.uniform(0.5, 1.5, n_trees)
    placements['cosine'], placements['sine'] = np.cos(0.5 * yaw), np.sin(0.5 * yaw)
    placements['is_still'][2] = 1
    instances = np.zeros(n_trees, dtype=bank.instance.dtype)
    for instance in instances:
        instance['eta'], instance['rate'], instance['force'] = random_state(bank, rng, 0.1)
    instances['eta'][4, 0] = np.nan
    laws = np.array([[0.5, 0.4, 0.3]])
    winds = rng.normal(0.0, 6.0, (n_trees, 3))
    winds[5] = 200.0, 0.0, 0.0
    given = bank.record, bank.time_step
    kernel, twin = ((placements.copy(), instances.copy()) for _ in range(2))
    assert step_stand(*given, *kernel, laws, winds) == (2, 1)
    assert numpy_stand.step_stand(*given, *twin, laws, winds) == (2, 1)
    assert np.array_equal(kernel[0], twin[0])
    for name in ('eta', 'rate', 'force'):
        scale = np.abs(kernel[1][name]).max()
        assert twin[1][name] == pytest.approx(kernel[1][name], rel=0.0, abs=3e-6 * scale)


@pytest.mark.parametrize('name', ['bench', 'benjamina'])
def test_a_tree_that_is_turned_and_scaled_is_placed_as_by_the_kernel(name):
    tree = bench_tree() if name == 'bench' else builtin_tree(name)
    bank = make_simulator(tree, model=12).banks[0]
    rng = np.random.default_rng(3)
    rotations = rng.normal(0.0, 0.1, int(bank.branches['n_coordinates'].sum()))
    origin, turned = np.array([4.0, -2.0, 1.0]), (np.cos(0.6), np.sin(0.6), 1.7)
    poses, twin = np.zeros((2, tree.n_segments, 7))
    bases, room = np.zeros((len(bank.branches), 8)), room_for(len(rotations))
    place(*GIVEN, bank.segments, bank.blocks, bases, *turned, room, rotations, origin, poses)
    NumpyPlacing(bank.branches, bank.segments).place(rotations, origin, twin, *turned)
    assert np.abs(poses[:, :3] - origin).max() > tree.height
    assert twin == pytest.approx(poses, abs=1e-8 * tree.height)


RUNS = """
import sys

import numpy as np
from tree_sway_lab.bench.bench_tree import bench_tree

from tree_sway.core.scene.make import make_simulator
from tree_sway.core.scene.placed_tree import PlacedTree
from tree_sway.core.scene.received_scene import ReceivedKind, ReceivedScene
from tree_sway.core.model.exported_table import exported_table
from tree_sway.core.scene.scene import Scene
from tree_sway.core.run.pushes import Spring
from tree_sway.stream.placing import Placer
from tree_sway.stream.protocol import decode_description, decode_frame
from tree_sway.stream.scene_state import SceneState

tree = bench_tree()


def run(simulator, act=lambda step: None):
    rng, poses = np.random.default_rng(5), []
    for step in range(240):
        act(step)
        wind = 9.0 + 5.0 * np.sin(step / 9.0) + rng.normal(), rng.normal(0.0, 2.0), rng.normal()
        simulator.step(wind, 1.0 / 60.0)
        if step % 20 == 19:
            poses.append(simulator.place()[:, :3].copy())
    return np.array(poses)


def pushed(simulator, segment):
    def act(step):
        if step == 30:
            simulator.push(segment, (5.0, 20.0, 0.0), 1.0)
        if step == 120:
            simulator.push(segment + 9, Spring(np.array([1.0, 0.5, 2.0]), 50.0), 0.5)

    return run(simulator, act)


def tuned(simulator):
    changes = {'stiffness_factor': 0.6, 'damping_ratio': 0.1}
    return run(simulator, lambda step: simulator.tune(**changes) if step == 50 else None)


def stand():
    places = (0.0, 0.0, 0.3, 1.2), (5.0, 1.0, 2.0, 0.8), (-3.0, 4.0, 0.0, 1.0)
    trees = [PlacedTree(f't{k}', tree, x, y, yaw=yaw, scale=scale)
             for k, (x, y, yaw, scale) in enumerate(places)]
    return Scene(trees).simulator(model=30)


def received(simulator):
    state = SceneState(simulator)
    description = decode_description(state.description)
    frame = decode_frame(state.frame(0))
    return Placer(description).place(description.coordinates(frame))[None, :, :3]


swaying = stand()
one = make_simulator(tree, model=60)
found = {
    'alone': run(one),
    'received': received(one),
    'few coordinates': run(make_simulator(tree, model=12)),
    'limb by limb': run(make_simulator(tree, model=40, crown_coherence=0.4)),
    'auto': run(make_simulator(tree, model='auto')),
    'tuned': tuned(make_simulator(tree, model=60)),
    'pushed': pushed(make_simulator(tree, model=60), 40),
    'a stand': run(swaying),
    'a received stand': received(swaying),
    'a tree of a stand pushed': pushed(stand(), tree.n_segments + 40),
}
np.savez(sys.argv[1], **found)
"""


def test_poses_without_numba_are_those_with_it(tmp_path):
    """Everything that moves a tree, in two processes, of which one has no compiler."""
    found = []
    for plain in ('', '1'):
        path = tmp_path / f'poses{plain}.npz'
        environment = {**os.environ, PLAIN_VARIABLE: plain}
        subprocess.run([sys.executable, '-c', RUNS, str(path)], env=environment, check=True)
        found.append(np.load(path))
    compiled, plain = found
    height = bench_tree().height
    assert set(compiled) == set(plain)
    for name in compiled:
        # The quaternions and offsets of received states are of single precision.
        assert np.abs(plain[name] - compiled[name]).max() < 1e-5 * height, name
        if not name.startswith(('received', 'a received')):
            moved = np.abs(compiled[name] - compiled[name].mean(axis=0)).max()
            assert moved > 0.02 * height, name
