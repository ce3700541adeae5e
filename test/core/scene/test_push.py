# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A tree of a stand that is pushed: as the same tree alone, turned, scaled, and no other."""

from __future__ import annotations

from drawn_trees import crown, WOOD
import numpy as np
import pytest
from simulators import AUTO, FULL

from tree_sway.core.run.pushes import MOST_PUSHES, Spring
from tree_sway.core.scene.make import make_simulator
from tree_sway.core.scene.placed_tree import PlacedTree
from tree_sway.core.scene.scene import Scene
from tree_sway.core.settings import Settings
from tree_sway.errors import ParameterError

DT, YAW = 1.0 / 60.0, 0.7
CALM = (0.0, 0.0, 0.0)
TURN = np.array(
    [[np.cos(YAW), -np.sin(YAW), 0.0], [np.sin(YAW), np.cos(YAW), 0.0], [0.0, 0.0, 1.0]]
)


@pytest.fixture(scope='module')
def tree():
    return crown()


@pytest.fixture(scope='module')
def resting(tree):
    """Return a stand at rest, which the tests of refusals share."""
    return stand_of(tree)


def stand_of(tree, scale=1.0, own=None):
    """Return a stand whose first tree is turned and scaled; a last one may have its own model."""
    trees = [
        PlacedTree('turned', tree, 10.0, 5.0, yaw=YAW, scale=scale, species=WOOD),
        PlacedTree('other', tree, 20.0, 5.0, species=WOOD),
    ]
    if own is not None:
        trees.append(PlacedTree('own', tree, 30.0, 5.0, species=WOOD, model=own))
    return Scene(trees).simulator(Settings(model=20))


@pytest.mark.parametrize('kind', ['force', 'spring'])
@pytest.mark.parametrize('scale', [1.0, 1.3])
def test_a_tree_of_a_stand_moves_as_it_would_alone(tree, scale, kind):
    stand, alone = stand_of(tree, scale), make_simulator(tree, WOOD, model=20)
    segment, force, away = int(tree.branch_first[-2] + 2), np.array([3.0, 1.0, 0.5]), [0.3, 0.1, 0]
    rest, whole = alone.place()[segment, :3].copy(), stand.place()
    there = whole[segment, :3].copy()
    pushes = (
        (force, TURN @ force * scale**2)
        if kind == 'force'
        else (
            Spring(rest + away, 20.0),
            Spring(there + TURN @ np.array(away) * scale, 20.0 * scale),
        )
    )
    for step in range(261):
        if step < 200:
            alone.push(segment, pushes[0], 0.5, along=0.0)
            stand.push(segment, pushes[1], 0.5 * scale, along=0.0)
        alone.step(CALM, DT)
        stand.step(CALM, scale * DT)  # a tree k times as large swings k times slower
        if step in (199, 260):
            moved = alone.place()[segment, :3] - rest
            found = TURN.T @ (stand.place()[segment, :3] - there) / scale
            # Coefficients are filled for scales to a hundredth.
            allowed = 1e-6 if scale == 1.0 else 0.05
            np.testing.assert_allclose(found, moved, atol=allowed * np.linalg.norm(moved))
    assert np.linalg.norm(moved) > 1e-4
    n = tree.n_segments
    np.testing.assert_array_equal(stand.place()[n : 2 * n], whole[n : 2 * n])


@pytest.mark.parametrize('own', [*AUTO, *FULL])
def test_a_tree_on_a_model_of_its_own_is_pushed_too(tree, own):
    stand = stand_of(tree, own=own)
    n, before = tree.n_segments, stand.place()
    for _ in range(60):
        stand.push(2 * n + 5, (20.0, 0.0, 0.0), 0.5)
        stand.step(CALM, DT)
    moved = stand.place() - before
    assert np.abs(moved[2 * n :, :3]).max() > 1e-3
    assert not moved[: 2 * n].any()
    stand.reset()
    stand.step(CALM, DT)
    np.testing.assert_allclose(stand.place(), before, atol=1e-12)


@pytest.mark.parametrize(
    ('segment', 'force', 'why'),
    [
        (-1, (1.0, 0.0, 0.0), 'no segment'),
        (10**6, (1.0, 0.0, 0.0), 'no segment'),
        ('stem', (1.0, 0.0, 0.0), 'no segment'),
        (1, (float('nan'), 0.0, 0.0), 'push'),
        (1, 'hard', 'push'),
        (1, Spring((0.0, 0.0, 1.0), -1.0), 'stiffness'),
        (1, Spring((0.0, 0.0), 1.0), 'push'),
    ],
)
def test_what_cannot_be_is_refused_and_counted(resting, segment, force, why):
    stand, refused = resting, resting.counts.refused_pushes
    with pytest.raises(ParameterError, match=why):
        stand.push(segment, force, 0.5)
    assert stand.counts.refused_pushes == refused + 1
    before = stand.place()
    stand.step(CALM, DT)
    np.testing.assert_array_equal(stand.place(), before)


def test_pushes_on_too_many_trees_are_refused(tree):
    trees = [PlacedTree(f't{k}', tree, 3.0 * k, 0.0, species=WOOD) for k in range(MOST_PUSHES + 1)]
    stand = Scene(trees).simulator(Settings(model=6))
    for number in range(MOST_PUSHES):
        stand.push(number * tree.n_segments, (1.0, 0.0, 0.0), DT)
    with pytest.raises(ParameterError, match='more than 64 trees'):
        stand.push(MOST_PUSHES * tree.n_segments, (1.0, 0.0, 0.0), DT)
    for _ in range(3):  # the pushes end, and others may come
        stand.step(CALM, DT)
    stand.push(MOST_PUSHES * tree.n_segments, (1.0, 0.0, 0.0), DT)
    assert stand.counts.refused_pushes == 1
