# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Placing: rest is the input, lengths and joints do not change, the chord turns by the key."""

from __future__ import annotations

from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from simulators import FULL

from tree_sway.core.run.assembly import bank_of
from tree_sway.core.settings import Settings
from tree_sway.core.setup.beams.shape_fields import across
from tree_sway.core.setup.preparation import prepare
from tree_sway.core.species.species import species_named
from tree_sway.core.tree.building import tree_from_segments

seeds = st.integers(0, 10**6)


class Puppet:
    """A tree that is placed at key rotations given by hand."""

    def __init__(self, tree, model=12, enrich='none'):
        chosen = Settings(model=model, enrich=enrich, gravity=0.0)
        self.tree = tree
        self.bank = bank_of(prepare(tree, species_named('broadleaf'), chosen))
        self.n = len(self.bank.oscillators.rotations())

    def poses(self, x):
        out = np.empty((self.tree.n_segments, 7))
        self.bank.place(np.array(x, float), out)
        return out

    def nodes(self, x):
        """Start and end of each segment."""
        out = self.poses(x)
        ahead = Rotation.from_quat(out[:, 3:]).apply([1.0, 0.0, 0.0])
        return out[:, :3], out[:, :3] + self.tree.length[:, None] * ahead

    def random(self, seed, largest=1.5):
        """Key rotations of up to a size in every branch, a tenth of it in further fields."""
        rng = np.random.default_rng(seed)
        x = rng.uniform(-0.1, 0.1, self.n) * largest
        for branch in self.bank.branches:
            i, heading = branch['coordinate'], rng.uniform(0, 2 * np.pi)
            x[i : i + 2] = rng.uniform(0, largest) * np.array([np.cos(heading), np.sin(heading)])
        return x


@pytest.fixture(scope='module', params=['none', 'all'])
def puppet(fork, request):
    return Puppet(fork(), enrich=request.param)


@pytest.fixture(scope='module')
def gappy(random_tree):
    """Make a random tree whose segments end a little before the next, away from the origin."""
    start, end, diameter, parent = random_tree(5, 30)
    return tree_from_segments(
        start + 3.0, end + 3.0 - 0.1 * (end - start), diameter, parent=parent
    )


@pytest.fixture(scope='module')
def gappy_doll(gappy):
    return Puppet(gappy)


@pytest.mark.parametrize('seed', range(2))
@pytest.mark.parametrize('model', ['branch', 12, *FULL])
def test_at_rest_the_poses_are_the_input(random_tree, model, seed):
    tree = tree_from_segments(*random_tree(seed, 25)[:3])
    doll = Puppet(tree, model)
    start, end = doll.nodes(np.zeros(doll.n))
    assert start == pytest.approx(tree.start, abs=1e-12)
    assert end == pytest.approx(tree.end, abs=1e-12)


def test_at_rest_gaps_are_the_inputs(gappy_doll):
    doll, gappy = gappy_doll, gappy_doll.tree
    start, end = doll.nodes(np.zeros(doll.n))
    assert start == pytest.approx(gappy.start, abs=1e-12)
    assert end == pytest.approx(gappy.end, abs=1e-12)


@given(seeds)
@settings(deadline=None)
def test_followers_keep_their_lengths_and_stay_joined(puppet, seed):
    x = puppet.random(seed)
    start, end = puppet.nodes(x)
    first = set(puppet.tree.branch_first.tolist())
    for j in range(1, puppet.tree.n_segments):
        if j not in first:
            assert start[j] == pytest.approx(end[j - 1], abs=1e-12)
    assert np.linalg.norm(end - start, axis=1) == pytest.approx(puppet.tree.length, abs=1e-9)
    assert np.linalg.norm(puppet.poses(x)[:, 3:], axis=1) == pytest.approx(1.0, abs=1e-9)


@given(seeds)
@settings(max_examples=30, deadline=None)
def test_gaps_keep_their_size(gappy_doll, seed):
    doll, gappy = gappy_doll, gappy_doll.tree
    start, end = doll.nodes(doll.random(seed))
    for b in range(gappy.n_branches):
        own = gappy.segments_of(b)
        gap = np.linalg.norm(start[own][1:] - end[own][:-1], axis=1)
        rest = np.linalg.norm(gappy.start[own][1:] - gappy.end[own][:-1], axis=1)
        assert gap == pytest.approx(rest, abs=1e-9)


@given(seeds)
@settings(deadline=None)
def test_children_stay_where_they_grow_on_their_parents(puppet, seed):
    poses, tree = puppet.poses(puppet.random(seed)), puppet.tree
    at_rest = puppet.poses(np.zeros(puppet.n))
    for b in range(1, tree.n_branches):
        j = tree.branch_first[b]
        seat = tree.segment_parent[j]
        seen = []
        for out in (poses, at_rest):
            own_frame = Rotation.from_quat(out[seat, 3:]).inv()
            seen.append(own_frame.apply(out[j, :3] - out[seat, :3]))
        assert seen[0] == pytest.approx(seen[1], abs=1e-12)


@pytest.mark.parametrize('enrich', ['none', 'all'])
def test_poses_are_those_of_the_keys_alone_bit_for_bit(fork, enrich):
    used, new = (Puppet(fork(), enrich=enrich) for _ in range(2))
    keys = 0.05 * used.random(3)
    used.poses(used.random(4))
    assert (used.poses(keys) == new.poses(keys)).all()


def test_keys_that_are_not_finite_spoil_no_later_pose(puppet):
    sound = puppet.poses(np.zeros(puppet.n))
    puppet.poses(np.full(puppet.n, np.nan))
    np.testing.assert_array_equal(puppet.poses(np.zeros(puppet.n)), sound)


def test_the_root_does_not_move(gappy_doll):
    moved = gappy_doll.poses(gappy_doll.random(1))
    assert moved[0, :3].tolist() == gappy_doll.tree.start[0].tolist()


def chord_turn(doll, angle, heading=0.4):
    """Rotation of the chord when the key rotation is `angle`, towards a heading."""
    tree = doll.tree
    x = angle * np.array([np.cos(heading), np.sin(heading)])
    start, end = doll.nodes(x)
    now, rest = end[-1] - start[0], tree.end[-1] - tree.start[0]
    b = rest / np.linalg.norm(rest)
    e1, e2 = across(b)
    sideways = now - (now @ b) * b
    # It turns towards (x, y) and nowhere else.
    to = np.cos(heading) * e1 + np.sin(heading) * e2
    assert sideways == pytest.approx((sideways @ to) * to, abs=1e-12)
    return np.arctan2(sideways @ to, now @ b)


@pytest.mark.parametrize('taper', [0.0, 0.5, 0.9])
@pytest.mark.parametrize(('degrees', 'within'), [(1, 1e-6), (10, 2e-5), (30, 1e-3)])
def test_the_chord_turns_by_the_key_rotation(stem, taper, degrees, within):
    angle = np.radians(degrees)
    for cuts in (1, 6, 20):
        tree = stem(tip=0.02 * (1 - taper), cuts=cuts, direction=(0.3, -0.2, 1.0))
        assert chord_turn(Puppet(tree), angle) == pytest.approx(angle, abs=within * angle)


@pytest.mark.parametrize('taper', [0.0, 0.9])
def test_the_chord_goes_on_with_the_key_where_the_shapes_change_over(stem, taper):
    doll = Puppet(stem(tip=0.02 * (1 - taper), cuts=12))
    angles = np.radians(np.linspace(0.0, 85.0, 171))
    turns = np.array([chord_turn(doll, angle) for angle in angles])
    assert turns == pytest.approx(angles, abs=0.02)
    steps = np.diff(turns)
    assert (steps > 0.0).all()
    assert steps.max() < 1.2 * steps.mean()


@pytest.mark.parametrize('taper', [0.0, 0.5])
def test_the_bent_branch_is_the_beams_curve(stem, taper):
    """The static slope, drawn with constant lengths: segments' angles over the key's, if small."""
    tree = stem(length=1.0, tip=0.02 * (1 - taper), cuts=40)
    doll = Puppet(tree, 'branch')
    small = 1e-3
    start, end = doll.nodes([small, 0.0])
    drawn = (end[:, 0] - start[:, 0]) / tree.length / small
    s = np.linspace(0, 1, 40001)
    load = 1 - taper * s
    shear = np.cumsum(load[::-1])[::-1]
    moment = np.cumsum(shear[::-1])[::-1]
    slope = np.cumsum(moment / (1 - taper * s) ** 4)
    slope /= slope.mean()
    middle = slope[np.arange(40) * 1000 + 500]
    assert drawn == pytest.approx(middle, abs=2e-3)


def test_a_whole_turn_of_the_heading_is_even(stem):
    """Two axes, no singular direction: an upright stem bends to any side as the same curve."""
    doll = Puppet(stem())
    reference = doll.nodes([0.6, 0.0])[1]
    for heading in np.linspace(0, 2 * np.pi, 7):
        end = doll.nodes(0.6 * np.array([np.cos(heading), np.sin(heading)]))[1]
        turn = Rotation.from_rotvec([0, 0, heading])
        assert end == pytest.approx(turn.apply(reference), abs=1e-12)


def test_a_twist_turns_children_and_leaves_the_stem(sketch):
    drawn = sketch()
    drawn.add(None, 0, (0, 0, 1), 2.0, 0.02, 0.02, 4)
    for side in (1.0, -1.0):
        drawn.add(0, 4, (side, 0, 0), 0.5, 0.01, 0.01, 2)
    tree = drawn.tree()
    doll = Puppet(tree, enrich='stem')
    x = np.zeros(doll.n)
    stem, side = doll.bank.branches[:2]
    per_key = side['twist'][: stem['n_coordinates'], 3:]
    last = int(np.argmax(np.abs(per_key[:, 2])))
    assert per_key[last, :2] == pytest.approx(0.0, abs=1e-9)
    x[last] = 0.5 / per_key[last, 2]
    start, end = doll.nodes(x)
    assert end[:4] == pytest.approx(tree.end[:4], abs=1e-9)
    assert end[5] - start[4] == pytest.approx(
        0.5 * np.array([np.cos(0.5), np.sin(0.5), 0]), abs=1e-9
    )
