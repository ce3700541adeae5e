# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Several trees in one wind: each moves as it would alone, turned, moved and in its own time."""

from __future__ import annotations

from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from simulators import AUTO

from tree_sway.core.run.outcome import Outcome
from tree_sway.core.scene.make import make_simulator
from tree_sway.core.scene.placed_tree import PlacedTree
from tree_sway.core.scene.scene import Scene
from tree_sway.core.scene.scene_simulator import SceneSimulator
from tree_sway.core.settings import Settings
from tree_sway.core.species.species import species_named
from tree_sway.core.wind.turbulence import Turbulence
from tree_sway.errors import ParameterError, TreeError

DT = 1.0 / 60.0


def swaying(trees, *, tolerance=0.005, convection_ratio=1.0, **changes):
    scene = Scene(trees, convection_ratio=convection_ratio)
    return SceneSimulator(scene, Settings(**changes), tolerance=tolerance)


def gusts(n, mean=8.0):
    return (
        np.array([mean, 0.0, 0.0])
        + Turbulence(mean).record(36_000, 60.0, np.random.default_rng(2))[:n]
    )


def turned(wind, yaw):
    """Return the wind in the frame of a tree that is turned by yaw."""
    return Rotation.from_euler('z', -yaw).apply(wind)


def test_one_tree_at_the_anemometer_moves_as_alone(fork):
    tree = fork()
    forest, alone = (
        swaying([PlacedTree('tree', tree)], model='branch'),
        make_simulator(tree, model='branch'),
    )
    for wind in gusts(120):
        assert forest.step(wind, DT) == alone.step(wind, DT) == Outcome.OK
        assert forest.place() == pytest.approx(alone.place(), abs=1e-12)
    assert forest.simulators[0].tip_displacement == pytest.approx(
        alone.tip_displacement, abs=1e-12
    )


@given(
    yaw=st.floats(-7.0, 7.0),
    x=st.floats(-30.0, 30.0),
    y=st.floats(-30.0, 30.0),
    model=st.just('branch'),
)
@settings(max_examples=12, deadline=None)
def test_a_turned_tree_moves_as_alone_in_the_turned_wind(fork, yaw, x, y, model):
    _turned_moves_as_alone(fork, yaw, x, y, model)


def test_a_turned_tree_of_all_coordinates_moves_as_alone(fork):
    _turned_moves_as_alone(fork, 1.0, 0.0, 0.0, 12)


def _turned_moves_as_alone(fork, yaw, x, y, model):
    tree = fork()
    one_wind = {'convection_ratio': np.inf, 'model': model}
    forest = swaying([PlacedTree('tree', tree, x=x, y=y, z=2.0, yaw=yaw)], **one_wind)
    alone = make_simulator(tree, model=model)
    for wind in gusts(30):
        forest.step(wind, DT)
        alone.step(turned(wind, yaw), DT)
    about = Rotation.from_euler('z', yaw)
    poses, own = forest.place(), alone.place()
    assert poses[:, :3] == pytest.approx(about.apply(own[:, :3]) + np.array([x, y, 2.0]), abs=1e-8)
    # How a segment is rolled about itself is free; the way it points is not.
    axes = [Rotation.from_quat(each[:, 3:]).apply([1.0, 0.0, 0.0]) for each in (poses, own)]
    assert axes[0] == pytest.approx(about.apply(axes[1]), abs=1e-8)


def test_a_gust_reaches_one_tree_after_the_other(stem):
    tree = stem(length=2.0, base=0.02, tip=0.006)
    row = [PlacedTree(f'tree{i}', tree, x=20.0 * i) for i in range(4)]
    forest = swaying(row, model='branch', damping_ratio=0.3)
    calm = np.tile([5.0, 0.0, 0.0], (1200, 1))
    calm[300:330, 0] = 10.0
    tips = []
    for wind in calm:
        forest.step(wind, DT)
        forest.place()
        tips.append([each.tip_displacement[0] for each in forest.simulators])
    arrival = np.argmax(tips, axis=0) * DT
    # 20 m at a mean of 5 m/s, a little more for the gust itself.
    assert np.diff(arrival) == pytest.approx(np.full(3, 4.0), abs=0.5)
    assert np.max(tips, axis=0) == pytest.approx(np.full(4, np.max(tips)), rel=0.05)


def test_the_block_holds_the_trees_one_after_another(fork, stem):
    forest = swaying([PlacedTree('a', fork()), PlacedTree('b', stem(), x=4.0)])
    block = np.full((forest.tree.n_segments, 7), np.nan)
    forest.step((6.0, 1.0, 0.0), DT)
    assert forest.place(block) is block
    assert np.isfinite(block).all()
    assert block[forest.segments_of('b')][0, :3] == pytest.approx([4.0, 0.0, 0.0])
    assert (block == forest.place()).all()
    with pytest.raises(ParameterError, match='use one of: a, b'):
        forest.segments_of('c')


def test_at_rest_the_block_is_that_of_the_joined_tree(fork, stem):
    forest = swaying([PlacedTree('a', fork(), yaw=1.0), PlacedTree('b', stem(), x=4.0)])
    assert forest.place()[:, :3] == pytest.approx(forest.tree.start, abs=1e-12)


def test_each_tree_may_have_a_species_and_a_model_of_its_own(stem):
    trees = [
        PlacedTree('a', stem()),
        PlacedTree('b', stem(), species=species_named('oak'), model='branch'),
    ]
    forest = swaying(trees, model='branch')
    assert forest.model == 'branch'
    assert [sim.models[0].species.key for sim in forest.simulators] == ['broadleaf', 'oak']


@pytest.mark.parametrize('bad', [(np.nan, 0, 0), (np.inf, 0, 0), (1e300, 0, 0), (500.0, 0, 0)])
def test_a_wind_that_cannot_be_is_refused_and_forgotten(fork, bad):
    forests = [
        swaying([PlacedTree(n, fork(), x=x) for n, x in (('a', 0.0), ('b', 9.0))]) for _ in '12'
    ]
    winds = gusts(200)
    for i, wind in enumerate(winds):
        status = forests[0].step(bad if i == 50 else wind, DT)
        assert status == (Outcome.WIND_REFUSED if i == 50 else Outcome.OK)
        forests[1].step(winds[49] if i == 50 else wind, DT)
    assert forests[0].counts.refused == 1
    assert forests[0].counts.steps == 200
    assert (forests[0].place() == forests[1].place()).all()


def test_reset_brings_every_tree_to_rest(fork):
    forest = swaying([PlacedTree('a', fork()), PlacedTree('b', fork(), x=9.0)])
    rest = forest.place().copy()
    runs = []
    for _ in range(2):
        for wind in gusts(100):
            forest.step(wind, DT)
        runs.append(forest.place().copy())
        forest.reset()
        assert (forest.place() == rest).all()
        assert all(np.abs(one.tip_displacement).max() <= 1e-14 for one in forest.simulators)
    assert (runs[0] == runs[1]).all()


def test_a_forest_that_cannot_be_is_refused(fork):
    with pytest.raises(ParameterError, match="2 trees called 'a'"):
        swaying([PlacedTree('a', fork()), PlacedTree('a', fork())])
    with pytest.raises(TreeError, match='no trees'):
        swaying([])
    with pytest.raises(ParameterError):
        swaying([PlacedTree('a', fork())]).step((1.0, 0.0, 0.0), 0.0)


def test_trees_in_leaf_sway_as_alone_in_leaf(fork):
    tree = fork()
    trees = [
        PlacedTree('bare', tree, leaf_on=False),
        PlacedTree('green', tree, leaf_on=True),
        PlacedTree('as asked', tree),
    ]
    forest = swaying(trees, in_leaf=True, convection_ratio=np.inf)
    alone = make_simulator(tree, in_leaf=True)
    for wind in gusts(60):
        forest.step(wind, DT)
        alone.step(wind, DT)
    poses, expected = forest.place(), alone.place()
    first, second, _ = (poses[forest.segments_of(each.name)] for each in trees)
    assert second == pytest.approx(expected, abs=1e-12)
    assert (first != second).any()


@pytest.mark.parametrize('model', AUTO)
def test_every_tree_finds_the_model_it_needs(fork, stem, model):
    trees = [
        PlacedTree('fork', fork()),
        PlacedTree('twig', stem(length=0.1, base=0.02, tip=0.01)),
    ]
    forest = swaying(trees, model=model, tolerance=1e-3)
    chosen = [each.choice.name for each in forest.simulators]
    assert chosen[1] == '0'
    assert int(chosen[0]) > 3
    assert forest.step((6.0, 0.0, 0.0), DT) == Outcome.OK
    assert forest.simulators[0].simulators == (forest.simulators[0],)


def test_an_error_names_the_tree(stem):
    thin = stem(length=30.0, base=0.02, tip=0.02)
    with pytest.raises(TreeError, match=r'^reed: '):
        swaying([PlacedTree('oak', stem()), PlacedTree('reed', thin)])
