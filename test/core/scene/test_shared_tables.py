# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Stands: many trees of a few kinds, each as if it were solved alone."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tree_sway.core.run.outcome import Outcome
from tree_sway.core.scene.make import make_simulator
from tree_sway.core.scene.placed_tree import PlacedTree
from tree_sway.core.scene.scene import Scene
from tree_sway.core.scene.scene_simulator import SceneSimulator
from tree_sway.core.settings import Settings
from tree_sway.errors import ParameterError

DT = 1.0 / 60.0


def swaying(trees, *, convection_ratio=1.0, **changes):
    settings = Settings(**{'model': 60, **changes})
    return SceneSimulator(Scene(trees, convection_ratio=convection_ratio), settings)


EVEN = {'convection_ratio': np.inf}


def winds(n, seed=4):
    rng = np.random.default_rng(seed)
    return np.array([5.0, 1.0, 0.1]) + np.cumsum(rng.normal(0.0, 0.3, (n, 3)), axis=0) * [1, 1, 0]


@pytest.fixture(scope='module')
def kinds(fork, mirror_fork):
    return {'fork': fork(), 'twin': mirror_fork()[0]}


def turned(wind, angle):
    c, s = np.cos(angle), np.sin(angle)
    return np.array([c * wind[0] - s * wind[1], s * wind[0] + c * wind[1], wind[2]])


def test_a_tree_of_a_stand_sways_as_it_does_alone(kinds):
    stand = swaying(
        [PlacedTree('a', kinds['twin']), PlacedTree('b', kinds['fork'], 4.0, 2.0, 0.5)], **EVEN
    )
    alone = make_simulator(kinds['fork'], model=60)
    for wind in winds(120):
        assert stand.step(wind, DT) == 0
        alone.step(wind, DT)
    placed = stand.place()[stand.segments_of('b')]
    # Rounding alone.
    place = np.abs(placed[:, :3] - [4.0, 2.0, 0.5] - alone.place()[:, :3]).max()
    turn = np.abs(placed[:, 3:] - alone.place()[:, 3:]).max()
    print(f'{place:.1e} m, {turn:.1e}')
    assert max(place, turn) < 1e-10


def test_a_turned_tree_in_a_turned_wind_is_the_same_tree_turned(kinds):
    stand = swaying(
        [PlacedTree('a', kinds['fork']), PlacedTree('b', kinds['fork'], yaw=0.8)], **EVEN
    )
    other = swaying(
        [PlacedTree('a', kinds['fork']), PlacedTree('b', kinds['fork'], yaw=0.8)], **EVEN
    )
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
    ends = poses[:, :3] + kinds['fork'].length[:, None] * along
    assert ends[0] == pytest.approx(poses[1, :3], abs=1e-9)


def test_a_scaled_tree_sways_as_one_that_is_calibrated_at_its_size(kinds):
    bare = Settings(gravity=0.0)
    stand = swaying([PlacedTree('big', kinds['fork'], scale=1.8)], **vars(bare), **EVEN)
    alone = make_simulator(stand._scene.trees[0].placed(), settings=bare, model=60)
    rest = alone.place()[:, :3].copy()
    for wind in winds(240):
        stand.step(wind, DT)
        alone.step(wind, DT)
    moved = np.linalg.norm(alone.place()[:, :3] - rest, axis=1).max()
    gap = np.linalg.norm(stand.place()[:, :3] - alone.place()[:, :3], axis=1).max()
    # Time steps are rounded to a hundredth of the scale.
    assert gap <= 0.02 * moved


def test_gusts_reach_one_tree_after_the_other(kinds):
    stand = swaying([PlacedTree('near', kinds['fork']), PlacedTree('far', kinds['fork'], x=30.0)])
    for number in range(60 * 12):
        stand.step((10.0 if number > 60 * 6 else 6.0, 0.0, 0.0), DT)
    assert stand.gusts.delay[1] > 2.0
    assert stand.gusts.delay[0] == 0.0


@pytest.fixture
def mixed(kinds):
    """Make a stand of every sort of tree."""

    def make(**changes):
        trees = [
            PlacedTree(
                f't{i}', kinds[('fork', 'twin')[i % 2]], 3.0 * i, scale=0.8 + 0.1 * i, yaw=0.5 * i
            )
            for i in range(5)
        ]
        trees += [
            PlacedTree('own', kinds['fork'], y=5.0, model='branch'),
            PlacedTree('still', kinds['twin'], y=9.0, model=0),
        ]
        stand = swaying(trees, **changes)
        for wind in winds(40):
            stand.step(wind, DT)
        return stand

    return make


def test_every_tree_has_its_own_model(kinds):
    stand = swaying(
        [
            PlacedTree('still', kinds['fork'], model=0),
            PlacedTree('shared', kinds['fork']),
            PlacedTree('own', kinds['fork'], model='branch'),
        ],
        **EVEN,
    )
    rest = stand.place()
    alone = make_simulator(kinds['fork'], model='branch')
    for wind in winds(60):
        stand.step(wind, DT)
        alone.step(wind, DT)
    moved = np.linalg.norm(stand.place() - rest, axis=1)
    assert (moved[stand.segments_of('still')] == 0.0).all()
    assert moved[stand.segments_of('shared')].max() > 1e-4
    assert (stand.place()[stand.segments_of('own')] == alone.place()).all()
    assert stand.model == '0, 60, branch'


def test_a_wind_beyond_the_table_is_clamped_and_counted(kinds):
    stand = swaying([PlacedTree(f't{i}', kinds['fork'], x=i) for i in range(3)], **EVEN)
    assert stand.step((75.0, 0.0, 0.0), DT) == Outcome.LOAD_CLAMPED
    assert stand.counts.clamped == 3
    assert stand.step((1.0, 0.0, 9.0), DT) == 0
    assert stand.step((0.0, 0.0, 9.0), DT) == 0
    assert stand.step((2.0, 0.0, 0.0), DT) == 0
    assert stand.counts.clamped == 3
    for _ in range(600):
        stand.step((75.0, 20.0, 5.0), DT)
    assert np.isfinite(stand.place()).all()


@pytest.mark.parametrize('wind', [(np.nan, 0.0, 0.0), (1e300, 0.0, 0.0), (0.0, np.inf, 0.0)])
def test_a_wind_that_is_none_is_refused_and_the_old_one_kept(kinds, wind):
    stand = swaying([PlacedTree('a', kinds['fork'])])
    stand.step((3.0, 0.0, 0.0), DT)
    assert stand.step(wind, DT) == Outcome.WIND_REFUSED
    assert stand.wind == pytest.approx([3.0, 0.0, 0.0])
    assert stand.counts.refused == 1


def test_a_motion_that_is_not_finite_goes_on_from_rest(kinds):
    stand = swaying([PlacedTree('a', kinds['fork']), PlacedTree('b', kinds['fork'], x=2.0)])
    stand.step((3.0, 0.0, 0.0), DT)
    stand._shared.stand.states.eta[0] = np.nan
    assert stand.step((3.0, 0.0, 0.0), DT) & Outcome.RESTARTED
    assert np.isfinite(stand.place()).all()
    assert stand.counts.restarted == 1


def test_a_stand_at_rest_is_the_trees_at_rest(kinds):
    stand = swaying([PlacedTree('a', kinds['fork'], 1.0, 2.0, scale=0.5, yaw=1.0)])
    assert stand.place()[:, :3] == pytest.approx(stand.tree.start, abs=1e-12)
    for wind in winds(20):
        stand.step(wind, DT)
    assert np.linalg.norm(stand.tip_displacement) > 0.0
    stand.reset()
    assert stand.tip_displacement == pytest.approx(np.zeros(3), abs=1e-12)


def test_what_cannot_stand_is_refused_by_name(kinds):
    with pytest.raises(ParameterError, match=r"b: .*unknown model 'fall'.*did you mean 'full'"):
        PlacedTree('b', kinds['fork'], model='fall')
    with pytest.raises(ParameterError, match='c: a pose'):
        PlacedTree('c', kinds['fork'], x=np.nan)
    with pytest.raises(ParameterError, match='d: scale'):
        PlacedTree('d', kinds['fork'], scale=np.nan)
    thin = replace(
        kinds['fork'],
        base_diameter=kinds['fork'].base_diameter / 40.0,
        tip_diameter=kinds['fork'].tip_diameter / 40.0,
    )
    with pytest.raises(Exception, match=r'e: .*buckles'):
        swaying([PlacedTree('e', thin)])


@pytest.mark.parametrize('dt', [-1.0, 0.0, np.nan, np.inf])
def test_a_step_of_no_time_takes_no_wind(kinds, dt):
    tree = kinds['fork']
    stand = swaying([PlacedTree('a', tree), PlacedTree('b', tree, model='branch')])
    stand.step((3.0, 0.0, 0.0), DT)
    before, counts = stand.place(), stand.counts
    with pytest.raises(ParameterError, match='time step'):
        stand.step((9.0, 1.0, 0.0), dt)
    assert stand.wind == pytest.approx([3.0, 0.0, 0.0])
    assert (stand.place() == before).all()
    assert stand.counts == counts
