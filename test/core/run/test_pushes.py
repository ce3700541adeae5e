# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A branch that is pushed: moments by differences, compliance, reaction, release, refusals."""

from __future__ import annotations

from drawn_trees import crown, Sketch, towards, UP, WOOD
import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from simulators import AUTO, FULL

from tree_sway.core.run.outcome import Outcome
from tree_sway.core.run.pushes import MOST_PUSHES, Spring, Touch
from tree_sway.core.scene.make import make_simulator
from tree_sway.core.setup.reductions import TreeReductions
from tree_sway.errors import ParameterError
from tree_sway.growth.builtin import builtin_tree

DT = 1.0 / 60.0
CALM = (0.0, 0.0, 0.0)
SETTLING, DAMPING = 5.0, 0.3
"""Time in which a tree that is damped so comes to rest [s], and the ratio of its damping."""


@pytest.fixture(scope='module')
def tree():
    return crown()


def fronds():
    """Draw a bare stem with arching fronds at its top."""
    to = Sketch(1)
    to.shoot(None, 0, UP, 8.0, 0.15, 0.11, 10)
    for k in range(5):
        to.shoot(0, -1, towards(72.0 * k, 15.0 * k), 2.5, 0.030, 0.006, 7, rise=-11.0)
    return to.tree()


def place_of(poses, tree, segment, along=0.5):
    """Where on a segment the push acts, (3,)."""
    away = (along * tree.length[segment], 0.0, 0.0)
    return poses[segment, :3] + Rotation.from_quat(poses[segment, 3:]).apply(away)


def moved(sim, segment):
    """Displacement from rest of the middle of a segment, (3,)."""
    tree = sim.tree
    return place_of(sim.place(), tree, segment) - 0.5 * (tree.start[segment] + tree.end[segment])


def outer_segment(tree):
    """Return a segment half way along the last branch, far from the root."""
    return int(tree.branch_first[-2] + 2)


@pytest.mark.parametrize(('name', 'along'), [('crown', 0.0), ('crown', 0.3), ('frond', 1.0)])
def test_moments_are_the_derivatives_of_places(tree, name, along):
    if name == 'frond':  # whose branches are cut, as of the other the stem alone
        tree = fronds()
    sim = make_simulator(tree, WOOD, model=60)
    assert (len(sim.banks[0].branches) > tree.n_branches + 1) == (name == 'frond')
    for _ in range(90):
        sim.step((14.0, 5.0, 1.0), DT)
    x = 5.0 * sim.rotations()
    poses = sim.place_rotations(x)
    assert np.abs(x).max() > 0.05  # it is bent
    rng = np.random.default_rng(3)
    for segment in (outer_segment(tree), 1, tree.n_segments - 1):
        touch, force = Touch(tree, sim.banks[0]), rng.normal(size=3)
        touch.add(segment, force, 1.0, along)
        push = touch.pushes[segment]
        touch._renew(push, push.place(poses), x.copy())
        by_differences = np.empty(len(x))
        for i, step in enumerate(np.eye(len(x)) * 1e-5):
            there, back = (
                place_of(sim.place_rotations(x + sign * step), tree, segment, along)
                for sign in (1.0, -1.0)
            )
            by_differences[i] = force @ (there - back) / 2e-5
        largest = np.abs(by_differences).max()
        np.testing.assert_allclose(force @ push.lever, by_differences, atol=1e-3 * largest)


@pytest.mark.parametrize('model', [60, *AUTO])
def test_the_foot_holds_the_force(tree, model):
    segment, force = outer_segment(tree), np.array([3.0, 1.0, -0.5])
    sim = make_simulator(tree, WOOD, model=model, damping_ratio=DAMPING)
    for _ in range(round(SETTLING / DT)):
        sim.push(segment, force, 1.0)
        sim.step(CALM, DT)
    assert moved(sim, segment) @ force > 0.0
    np.testing.assert_allclose(sim.push_load[:3], force)
    arm = place_of(sim.place(), tree, segment) - tree.start[0]
    np.testing.assert_allclose(sim.push_load[3:], np.cross(arm, force), rtol=1e-3)


def test_twice_the_force_moves_twice_as_far_where_it_bends_little(tree):
    segment = outer_segment(tree)
    found = []
    for scale in (0.01, 0.02):
        sim = make_simulator(tree, WOOD, model=60, damping_ratio=DAMPING)
        for _ in range(round(SETTLING / DT)):
            sim.push(segment, (scale, 0.0, 0.0), 1.0)
            sim.step(CALM, DT)
        found.append(moved(sim, segment))
    np.testing.assert_allclose(found[1], 2.0 * found[0], rtol=0.01, atol=1e-9)


def test_it_acts_for_its_time_then_swings_freely(tree):
    segment = outer_segment(tree)
    sim = make_simulator(tree, WOOD, model=60)
    sim.push(segment, (5.0, 0.0, 0.0), 0.5)
    for _ in range(30):
        sim.step(CALM, DT)
        assert sim.push_load[0] == 5.0
    sim.step(CALM, DT)
    assert not sim.push_load.any()
    own_chord = [np.linalg.norm(moved(sim, segment))]
    for _ in range(round(30.0 / DT)):
        sim.step(CALM, DT)
        own_chord.append(np.linalg.norm(moved(sim, segment)))
    assert 0.0 < max(own_chord[-120:]) < 0.1 * max(own_chord)


def test_a_force_beyond_bounds_is_clamped_and_counted(tree):
    sim = make_simulator(tree, WOOD, model=60)
    sim.push(outer_segment(tree), (1e12, 0.0, -1e12), 1.0)
    statuses = {sim.step(CALM, DT) for _ in range(60)}
    assert Outcome.LOAD_CLAMPED in statuses
    assert sim.counts.clamped > 0
    assert np.isfinite(sim.place()).all()


@pytest.mark.parametrize(
    ('segment', 'force', 'seconds', 'along'),
    [
        (-1, (1.0, 0.0, 0.0), 1.0, 0.5),
        (10**9, (1.0, 0.0, 0.0), 1.0, 0.5),
        (1, (np.nan, 0.0, 0.0), 1.0, 0.5),
        (1, (np.inf, 0.0, 0.0), 1.0, 0.5),
        (1, (1.0, 0.0), 1.0, 0.5),
        (1, 'hard', 1.0, 0.5),
        (1, None, 1.0, 0.5),
        (1, (1.0, 0.0, 0.0), 0.0, 0.5),
        (1, (1.0, 0.0, 0.0), np.nan, 0.5),
        (1, (1.0, 0.0, 0.0), 1e9, 0.5),
        (1, (1.0, 0.0, 0.0), 1.0, 1.5),
        (1.5, (1.0, 0.0, 0.0), 1.0, 0.5),
        ('stem', (1.0, 0.0, 0.0), 1.0, 0.5),
    ],
)
def test_a_push_that_cannot_be_is_refused_and_counted(tree, segment, force, seconds, along):
    sim = make_simulator(tree, WOOD, model=20)
    with pytest.raises(ParameterError, match='push'):
        sim.push(segment, force, seconds, along=along)
    assert sim.counts.refused_pushes == 1
    sim.step(CALM, DT)
    assert not sim.push_load.any()


def test_branches_by_themselves_cannot_be_pushed(tree):
    sim = make_simulator(tree, WOOD, model='branch')
    with pytest.raises(ParameterError, match='branch'):
        sim.push(1, (1.0, 0.0, 0.0), 1.0)
    assert sim.counts.refused_pushes == 1


def test_a_reset_ends_every_push(tree):
    sim = make_simulator(tree, WOOD, model=20)
    sim.push(1, (1.0, 0.0, 0.0), 9.0)
    sim.step(CALM, DT)
    sim.reset()
    sim.step(CALM, DT)
    assert not sim.rotations().any()


@pytest.mark.parametrize('model', [60, *FULL])
@pytest.mark.parametrize('stiffness', [30.0, 1e6])
def test_a_spring_holds_a_branch_between_its_rest_and_its_place(tree, model, stiffness):
    segment = outer_segment(tree)
    sim = make_simulator(tree, WOOD, model=model, damping_ratio=DAMPING)
    rest = 0.5 * (tree.start[segment] + tree.end[segment])
    to = rest + np.array([0.2, 0.1, 0.0])
    for _ in range(round(SETTLING / DT)):
        sim.push(segment, Spring(to, stiffness), 0.5)
        sim.step(CALM, DT)
    place = place_of(sim.place(), tree, segment)
    force = sim.push_load[:3]
    assert 0.0 < np.linalg.norm(to - place) < np.linalg.norm(to - rest)
    if stiffness < 100.0:  # as stiff as it is: a step can follow it
        np.testing.assert_allclose(force, stiffness * (to - place), rtol=1e-3, atol=1e-3)
    pushed = make_simulator(tree, WOOD, model=model, damping_ratio=DAMPING)
    for _ in range(round(SETTLING / DT)):
        pushed.push(segment, force, 0.5)
        pushed.step(CALM, DT)
    there = moved(pushed, segment)
    np.testing.assert_allclose(place - rest, there, atol=0.02 * np.linalg.norm(there))


def test_springs_that_are_none_and_pushes_that_are_too_many_are_refused(tree):
    sim = make_simulator(tree, WOOD, model=6)
    for stiffness in (0.0, -1.0, float('nan'), 1e9):
        with pytest.raises(ParameterError, match='stiffness'):
            sim.push(1, Spring((0.0, 0.0, 1.0), stiffness), 1.0)
    for segment in range(MOST_PUSHES):
        sim.push(segment, (1.0, 0.0, 0.0), 1.0)
    with pytest.raises(ParameterError, match='more than 64 pushes'):
        sim.push(MOST_PUSHES, (1.0, 0.0, 0.0), 1.0)
    assert sim.counts.refused_pushes == 5


def test_a_limb_gives_way_as_with_all_coordinates():
    tree = builtin_tree('goldcrest')
    sim = make_simulator(tree, model=60)
    sim.tune(damping_ratio=0.5)
    reductions = TreeReductions(sim.tree, sim.models[0].species, sim.settings)
    factors, n_rotations = reductions.with_subtrees.reduction.factors, len(sim.rotations())
    lengths = np.add.reduceat(tree.length, tree.branch_first[:-1])
    limbs = np.flatnonzero(tree.branch_parent == 0)
    longest = limbs[np.argsort(lengths[limbs])[::-1][:7:3]]
    errors = []
    for branch in longest:
        first, end = tree.branch_first[branch : branch + 2]
        touch = Touch(tree, sim.banks[0])
        segment = int(first + round(0.7 * (end - first - 1)))
        touch.add(segment, (1.0, 0.0, 0.0), 1.0, 0.0)
        push, x = touch.pushes[segment], np.zeros(n_rotations)
        touch._renew(push, tree.start[segment], x)
        whole = push.lever @ factors.solve(push.lever.T)
        _, across = np.linalg.eigh(whole)
        for way in across.T[1:]:
            goal = whole @ way  # of little forces, so 1 mm far
            force = 0.001 / np.linalg.norm(goal) * way
            sim.reset()
            for _ in range(round(SETTLING / DT)):
                sim.push(segment, force, 1.0, along=0.0)
                sim.step(CALM, DT)
            goal *= 0.001 / np.linalg.norm(goal)
            move = sim.place()[segment, :3] - tree.start[segment]
            errors.append(np.linalg.norm(move - goal) / 0.001)
    assert max(errors) < 0.03


@pytest.mark.parametrize('model', [20, *AUTO, *FULL])
def test_a_spring_at_the_foot_of_the_stem_moves_nothing(tree, model):
    pulled, alone = (make_simulator(tree, WOOD, model=model, tolerance=1e-9) for _ in range(2))
    for number in range(120):
        if number % 20 == 0:
            pulled.push(0, Spring((3.0, 0.0, 1.0), 1e6), 0.5, along=0.0)
        for each in (pulled, alone):
            each.step((6.0, 1.0, 0.0), DT)
    np.testing.assert_allclose(pulled.place(), alone.place(), atol=1e-9)
    assert pulled.push_load[0] > 1e5


@pytest.mark.parametrize('stiffness', [1e-12, 50.0, 1e7])
@pytest.mark.parametrize('far', [0.0, 1e5])
def test_a_spring_at_any_segment_and_place_leaves_the_motion_finite(stiffness, far):
    tree = crown((3, 3, 3), 3)
    sim = make_simulator(tree, WOOD, model=20)
    for segment in range(tree.n_segments):
        for along in (0.0, 1.0):
            sim.push(segment, Spring((far, -far, far), stiffness), 0.05, along=along)
            sim.step((6.0, 1.0, 0.0), DT)
            assert np.isfinite(sim.place()).all()
    assert sim.counts.restarted == 0
