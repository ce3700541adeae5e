# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A branch pulled by one tenth of the tree's height, beside MuJoCo with every segment solved."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from tree_sway_lab.compare.mujoco_tree import MujocoTree
from tree_sway_lab.example_trees import forked_tree
from tree_sway_lab.kinds.kinds import kind_called

from tree_sway.core.scene.make import make_simulator
from tree_sway.core.settings import Settings
from tree_sway.core.species.species import Species
from tree_sway.identification.free_decay import free_decay

WOOD = Species('example', 'example', 8.0e9, 900.0)
DT = 1.0 / 60.0
DAMPING, CYCLES = 0.04, 12
"""Damping ratio of every mode of both, and cycles that are followed once it is let go."""

AT = 0.7
"""Height that is pulled at, as a share of the tree's."""


def pulled_segment(tree):
    """Find the segment at that height below the highest tip."""
    segment, chain = int(np.argmax(tree.end[:, 2])), []
    while segment >= 0:
        chain.append(segment)
        segment = int(tree.segment_parent[segment])
    height = tree.start[0, 2] + AT * tree.height
    return min(chain, key=lambda each: abs(tree.end[each, 2] - height))


def settled(model, segment, place, force):
    """Where MuJoCo has a place of a segment once it is still under a force, (3,)."""
    model.reset()
    body, data = model._body[segment + 1], model.data
    away, before = place - data.xpos[body], np.full(3, np.inf)
    for _ in range(100):
        for _ in range(1000):
            model.blow(np.zeros(3))
            now = data.xpos[body] + data.xmat[body].reshape(3, 3) @ away
            data.xfrc_applied[body] += [*force, *np.cross(now - data.xipos[body], force)]
            model.advance(1.0 / 500.0)
        if np.linalg.norm(now - before) < 1e-5 * model.tree.height:
            return now
        before = now
    raise AssertionError('it does not come to rest')


def released(truth, segment, place, seconds):
    """Where a place of a segment goes in MuJoCo from where it is now, let go, (n, 3)."""
    body, data = truth._body[segment + 1], truth.data
    away = data.xmat[body].reshape(3, 3).T @ (place - data.xpos[body])
    swing = []
    for _ in range(round(seconds * 60.0)):
        for _ in range(10):
            truth.blow(np.zeros(3))
            truth.advance(DT / 10.0)
        swing.append(data.xpos[body] + data.xmat[body].reshape(3, 3) @ away)
    return np.array(swing)


def decrement(swing, period):
    """Logarithmic decrement per cycle between the third and the tenth, of the root mean square."""
    cycle = round(period / DT)
    early, late = (np.sqrt(np.mean(swing[k * cycle : (k + 2) * cycle] ** 2)) for k in (2, 9))
    return np.log(early / late) / 7.0


def middle(simulator, segment):
    """Where the middle of a segment is, (3,)."""
    pose = simulator.place()[segment]
    half = (0.5 * simulator.tree.length[segment], 0.0, 0.0)
    return pose[:3] + Rotation.from_quat(pose[3:]).apply(half)


@pytest.mark.long
@pytest.mark.parametrize('name', ['leaning', 'forked', 'palm'])
def test_let_go_it_swings_and_decays_as_every_segment_solved(name):
    pytest.importorskip('mujoco', reason='needs MuJoCo (pip install mujoco)')
    tree = forked_tree(0.65, 0.6, generations=3) if name == 'forked' else kind_called(name)
    still, truth = (MujocoTree(tree, WOOD, ratio, even=ratio < 0.1) for ratio in (0.6, DAMPING))
    segment, along = pulled_segment(tree), np.array([1.0, 0.3, 0.0])
    place = 0.5 * (tree.start[segment] + tree.end[segment])
    softness = np.linalg.norm(settled(still, segment, place, 1e-3 * along) - place) / 1e-3
    force = 0.1 * tree.height / softness * along
    pulled = settled(still, segment, place, force)
    truth.take(still.data.qpos, np.zeros(still.model.nv))
    period = 1.0 / float(truth.frequencies[0])
    whole = released(truth, segment, pulled, CYCLES * period)
    expected = free_decay(whole - place, DT, 1.0 / period).frequency
    decay = decrement(whole - place, period)
    for model in (60, 'full'):
        sims = []
        for ratio in (0.5, DAMPING):
            settings = Settings(model=model, gravity=0.0, damping_ratio=ratio, in_leaf=False)
            sims.append(make_simulator(tree, WOOD, settings))
        for _ in range(1200):
            sims[0].push(segment, force, 1.0)
            sims[0].step((0.0, 0.0, 0.0), DT)
        x, _ = sims[0].banks[0].oscillators.motion()
        sims[1].banks[0].oscillators.take_over(x, np.zeros(len(x)))
        swing = []
        for _ in range(len(whole)):
            sims[1].step((0.0, 0.0, 0.0), DT)
            swing.append(middle(sims[1], segment))
        there = np.array(swing) - place
        found = free_decay(there, DT, 1.0 / period).frequency
        own = decrement(there, period)
        print(f'{name}, {model}: {found:.4f} Hz, MuJoCo {expected:.4f}; {own:.4f}, {decay:.4f}')
        assert found == pytest.approx(expected, rel=0.01)
        assert own == pytest.approx(decay, rel=0.03)


@pytest.mark.parametrize(
    'name',
    ['leaning', *(pytest.param(each, marks=pytest.mark.long) for each in ('forked', 'palm'))],
)
def test_a_pull_moves_the_tree_as_every_segment_solved(name):
    pytest.importorskip('mujoco', reason='needs MuJoCo (pip install mujoco)')
    tree = forked_tree(0.65, 0.6, generations=3) if name == 'forked' else kind_called(name)
    truth, segment = MujocoTree(tree, WOOD, 0.6, even=False), pulled_segment(tree)
    place = 0.5 * (tree.start[segment] + tree.end[segment])
    along = np.array([1.0, 0.3, 0.0])
    softness = np.linalg.norm(settled(truth, segment, place, 1e-3 * along) - place) / 1e-3
    force = 0.1 * tree.height / softness * along
    moved = settled(truth, segment, place, force) - place
    assert 0.08 < np.linalg.norm(moved) / tree.height < 0.13
    for model in (60, 'full'):
        settings = Settings(model=model, gravity=0.0, damping_ratio=0.5, in_leaf=False)
        simulator = make_simulator(tree, WOOD, settings)
        for _ in range(1200):
            simulator.push(segment, force, 1.0)
            simulator.step((0.0, 0.0, 0.0), 1.0 / 60.0)
        pose = simulator.place()[segment]
        half = (0.5 * tree.length[segment], 0.0, 0.0)
        found = pose[:3] + Rotation.from_quat(pose[3:]).apply(half) - place
        assert np.linalg.norm(found - moved) < 0.03 * np.linalg.norm(moved)
