# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Stands: many trees of a few kinds, each as if it were solved alone."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tree_sway_ros.core.scene.stand import Stand, StandKind, StandTree
from tree_sway_ros.core.simulator.settings import Settings
from tree_sway_ros.core.simulator.simulator import (
    LOAD_HELD,
    RESTARTED,
    SwaySimulator,
    WIND_REFUSED,
)
from tree_sway_ros.core.state.tree_state import TreeState
from tree_sway_ros.errors import ParameterError, StateError

DT = 1.0 / 60.0
EVEN = {'convection_ratio': np.inf}


def winds(n, seed=4):
    rng = np.random.default_rng(seed)
    return np.array([5.0, 1.0, 0.1]) + np.cumsum(rng.normal(0.0, 0.3, (n, 3)), axis=0) * [1, 1, 0]


@pytest.fixture(scope='module')
def kinds(fork, mirror_fork):
    return {'fork': StandKind(fork()), 'twin': StandKind(mirror_fork()[0])}


def turned(wind, angle):
    c, s = np.cos(angle), np.sin(angle)
    return np.array([c * wind[0] - s * wind[1], s * wind[0] + c * wind[1], wind[2]])


def test_a_tree_of_a_stand_sways_as_it_does_alone(kinds):
    stand = Stand([StandTree('a', 'twin'), StandTree('b', 'fork', 4.0, 2.0, 0.5)], kinds, **EVEN)
    alone = SwaySimulator(kinds['fork'].tree, model='wind_basis')
    for wind in winds(120):
        assert stand.step(wind, DT) == 0
        alone.step(wind, DT)
    placed = stand.place()[stand.segments_of('b')]
    assert placed[:, :3] - [4.0, 2.0, 0.5] == pytest.approx(alone.place()[:, :3], abs=1e-12)
    assert placed[:, 3:] == pytest.approx(alone.place()[:, 3:], abs=1e-12)


def test_a_turned_tree_in_a_turned_wind_is_the_same_tree_turned(kinds):
    stand = Stand([StandTree('a', 'fork'), StandTree('b', 'fork', yaw=0.8)], kinds, **EVEN)
    other = Stand([StandTree('a', 'fork'), StandTree('b', 'fork', yaw=0.8)], kinds, **EVEN)
    for wind in winds(120):
        stand.step(wind, DT)
        other.step(turned(wind, 0.8), DT)
    straight = stand.place()[stand.segments_of('a'), :3]
    swung = other.place()[other.segments_of('b'), :3]
    assert swung == pytest.approx(np.array([turned(p, 0.8) for p in straight]), abs=1e-9)
    # And every segment ends where the next one starts.
    poses = other.place()[other.segments_of('b')]
    x, y, z, w = poses[:, 3:].T
    along = np.stack([1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)], axis=1)
    ends = poses[:, :3] + kinds['fork'].tree.length[:, None] * along
    assert ends[0] == pytest.approx(poses[1, :3], abs=1e-9)


def test_a_scaled_tree_sways_as_one_that_is_calibrated_at_its_size(kinds):
    bare = Settings(gravity=0.0)
    stand = Stand([StandTree('big', 'fork', scale=1.8)], kinds, bare, **EVEN)
    alone = SwaySimulator(stand.tree_of(0), settings=bare, model='wind_basis')
    rest = alone.place()[:, :3].copy()
    for wind in winds(240):
        stand.step(wind, DT)
        alone.step(wind, DT)
    moved = np.linalg.norm(alone.place()[:, :3] - rest, axis=1).max()
    gap = np.linalg.norm(stand.place()[:, :3] - alone.place()[:, :3], axis=1).max()
    # Paces are told to a hundredth of the scale.
    assert gap <= 0.02 * moved


def test_gusts_reach_one_tree_after_the_other(kinds):
    stand = Stand([StandTree('near', 'fork'), StandTree('far', 'fork', x=30.0)], kinds)
    for number in range(60 * 12):
        stand.step((10.0 if number > 60 * 6 else 6.0, 0.0, 0.0), DT)
    assert stand.gusts.delay[1] > 2.0
    assert stand.gusts.delay[0] == 0.0


def test_only_what_is_asked_for_is_placed(kinds):
    stand = Stand([StandTree(f't{i}', 'fork', x=3.0 * i) for i in range(4)], kinds)
    for wind in winds(30):
        stand.step(wind, DT)
    whole, some = stand.place(), np.full((stand.n_segments, 7), 9.0)
    stand.place(some, which=[1, 3])
    for number, name in enumerate(stand.names):
        rows = stand.segments_of(name)
        assert (some[rows] == (whole[rows] if number in (1, 3) else 9.0)).all()
    for wrong in ([4], [-1]):
        with pytest.raises(ParameterError, match='stand of 4'):
            stand.place(which=wrong)


@pytest.fixture
def mixed(kinds):
    """Make a stand of every sort of tree."""

    def make(**changes):
        trees = [
            StandTree(f't{i}', ('fork', 'twin')[i % 2], 3.0 * i, scale=0.8 + 0.1 * i, yaw=0.5 * i)
            for i in range(5)
        ]
        trees += [
            StandTree('own', 'fork', y=5.0, fidelity='subtree'),
            StandTree('still', 'twin', y=9.0, fidelity='frozen'),
        ]
        stand = Stand(trees, kinds, **changes)
        for wind in winds(40):
            stand.step(wind, DT)
        return stand

    return make


def test_threads_place_the_same_poses(mixed):
    one, many = mixed(), mixed(threads=3)
    assert (one.place() == many.place()).all()
    assert (one.place(which=[1, 5]) == many.place(which=[1, 5])).all()
    with pytest.raises(ParameterError, match='threads'):
        mixed(threads=0)


def test_the_poses_follow_from_the_rotations(mixed):
    stand = mixed()
    rotations = stand.rotations()
    assert stand.place_rotations(rotations) == pytest.approx(stand.place(), abs=1e-12)
    assert np.abs(rotations).max() > 1e-3


def test_a_stand_goes_on_from_its_state_bit_for_bit(mixed):
    stand = mixed()
    other, kept = mixed(), TreeState.from_bytes(stand.state().to_bytes())
    for wind in winds(20, seed=8):
        other.step(wind, DT)
    assert other.expand(kept) == pytest.approx(stand.place(), abs=1e-12)
    other.set_state(kept)
    for wind in winds(20, seed=9):
        stand.step(wind, DT)
        other.step(wind, DT)
    assert (stand.place() == other.place()).all()


def test_a_state_of_another_stand_is_refused_and_the_old_one_kept(mixed, kinds):
    stand = mixed()
    before, kept = stand.place(), stand.state()
    another = Stand([StandTree('t0', 'fork')], kinds).state()
    for wrong in (
        another,
        replace(kept, version=99),
        replace(kept, values=kept.values[:-1]),
        replace(kept, values=np.full_like(kept.values, np.nan)),
    ):
        with pytest.raises(StateError):
            stand.set_state(wrong)
        assert (stand.place() == before).all()


def test_every_tree_has_its_own_fidelity(kinds):
    stand = Stand(
        [
            StandTree('still', 'fork', fidelity='frozen'),
            StandTree('shared', 'fork'),
            StandTree('own', 'fork', fidelity='subtree'),
        ],
        kinds,
        **EVEN,
    )
    rest = stand.place()
    alone = SwaySimulator(kinds['fork'].tree, model='subtree')
    for wind in winds(60):
        stand.step(wind, DT)
        alone.step(wind, DT)
    moved = np.linalg.norm(stand.place() - rest, axis=1)
    assert (moved[stand.segments_of('still')] == 0.0).all()
    assert moved[stand.segments_of('shared')].max() > 1e-4
    assert (stand.place()[stand.segments_of('own')] == alone.place()).all()
    assert stand.model == 'wind_basis, subtree'
    assert stand.n_frozen == kinds['fork'].tree.n_branches


def test_a_wind_beyond_the_table_is_held_and_counted(kinds):
    stand = Stand([StandTree(f't{i}', 'fork', x=i) for i in range(3)], kinds, **EVEN)
    assert stand.step((60.0, 0.0, 0.0), DT) == LOAD_HELD
    assert stand.counts.held == 3
    assert stand.held == ('t0', 't1', 't2')
    assert stand.step((1.0, 0.0, 9.0), DT) == LOAD_HELD
    assert stand.step((0.0, 0.0, 9.0), DT) == LOAD_HELD
    assert stand.step((2.0, 0.0, 0.0), DT) == 0
    assert stand.held == ()
    for _ in range(600):
        stand.step((60.0, 20.0, 5.0), DT)
    assert np.isfinite(stand.place()).all()


@pytest.mark.parametrize('wind', [(np.nan, 0.0, 0.0), (1e300, 0.0, 0.0), (0.0, np.inf, 0.0)])
def test_a_wind_that_is_none_is_refused_and_the_old_one_kept(kinds, wind):
    stand = Stand([StandTree('a', 'fork')], kinds)
    stand.step((3.0, 0.0, 0.0), DT)
    assert stand.step(wind, DT) == WIND_REFUSED
    assert stand.wind == pytest.approx([3.0, 0.0, 0.0])
    assert stand.counts.refused == 1


def test_a_motion_that_is_not_finite_goes_on_from_rest(kinds):
    stand = Stand([StandTree('a', 'fork'), StandTree('b', 'fork', x=2.0)], kinds)
    stand.step((3.0, 0.0, 0.0), DT)
    stand._instances['eta'][0] = np.nan
    assert stand.step((3.0, 0.0, 0.0), DT) & RESTARTED
    assert np.isfinite(stand.place()).all()
    assert stand.counts.restarted == 1


def test_a_stand_at_rest_is_the_trees_at_rest(kinds):
    stand = Stand([StandTree('a', 'fork', 1.0, 2.0, scale=0.5, yaw=1.0)], kinds)
    assert stand.place()[:, :3] == pytest.approx(stand.tree.start, abs=1e-12)
    for wind in winds(20):
        stand.step(wind, DT)
    assert np.linalg.norm(stand.tip_displacement) > 0.0
    stand.reset()
    assert stand.tip_displacement == pytest.approx(np.zeros(3), abs=1e-12)


def test_what_cannot_stand_is_refused_by_name(kinds):
    with pytest.raises(ParameterError, match='no trees'):
        Stand([], kinds)
    with pytest.raises(ParameterError, match="2 trees called 'a'"):
        Stand([StandTree('a', 'fork'), StandTree('a', 'twin')], kinds)
    with pytest.raises(ParameterError, match=r"b: unknown kind 'oak'.*fork, twin"):
        Stand([StandTree('b', 'oak')], kinds)
    with pytest.raises(ParameterError, match='c: a pose'):
        StandTree('c', 'fork', x=np.nan)
    with pytest.raises(ParameterError, match='d: scale'):
        StandTree('d', 'fork', scale=np.nan)
    thin = replace(
        kinds['fork'].tree,
        base_diameter=kinds['fork'].tree.base_diameter / 40.0,
        tip_diameter=kinds['fork'].tree.tip_diameter / 40.0,
    )
    with pytest.raises(Exception, match=r'thin: .*buckles'):
        Stand([StandTree('e', 'thin')], {'thin': StandKind(thin)})
