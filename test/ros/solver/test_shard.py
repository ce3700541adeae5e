# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Stands divided among solvers: every tree in one shard, and swaying there as in the whole."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tree_sway.core.scene.placed_tree import PlacedTree
from tree_sway.core.scene.scene import Scene
from tree_sway.errors import ParameterError
from tree_sway_ros.solver.shard import shard_of


@pytest.fixture
def stand(fork, stem):
    kinds = fork(), stem()
    trees = [
        PlacedTree(f't{i}', kinds[i % 2], 4.0 * i, 3.0 * (i % 3), scale=1.0 + 0.1 * i)
        for i in range(7)
    ]
    return Scene(trees)


@pytest.mark.parametrize('shards', [1, 2, 3, 7])
def test_every_tree_is_in_one_shard_in_the_order_of_the_file(stand, shards):
    parts = [shard_of(stand, shard, shards) for shard in range(shards)]
    assert [each.name for part in parts for each in part.trees] == [e.name for e in stand.trees]
    assert all(part.trees for part in parts)


def test_a_giant_leaves_no_shard_without_a_tree(stand):
    giant = replace(stand.trees[0], tree=stand.tree)
    scene = replace(stand, trees=[*stand.trees[1:], giant])
    for trees in (scene.trees, scene.trees[::-1]):
        sizes = [len(shard_of(replace(scene, trees=trees), k, 4).trees) for k in range(4)]
        assert min(sizes) >= 1
        assert sum(sizes) == 7


def test_shards_sway_as_the_whole(stand):
    stand = replace(stand, anemometer=(-5.0, 0.0, 0.0))
    sims = [part.simulator() for part in (stand, shard_of(stand, 0, 2), shard_of(stand, 1, 2))]
    for k in range(90):
        for sim in sims:
            sim.step((6.0 + np.sin(0.3 * k), 1.0, 0.0), 1 / 60)
    whole, *parts = (sim.place() for sim in sims)
    assert (np.vstack(parts) == whole).all()


def test_a_stand_that_is_moved_sways_where_it_is(stand):
    moved = stand.moved(x=100.0, yaw=0.5)
    assert moved.simulator().place()[0, 0] == pytest.approx(moved.trees[0].x)


@pytest.mark.parametrize(
    ('shard', 'shards', 'what'),
    [(2, 2, 'shard 2 of 2'), (0, 8, '8 shards of 7'), (1, 1, '1 of 1')],
)
def test_a_shard_that_there_is_not_is_refused(stand, shard, shards, what):
    with pytest.raises(ParameterError, match=what):
        shard_of(stand, shard, shards)


def test_one_tree_cannot_be_divided(fork):
    with pytest.raises(ParameterError, match='2 shards of 1 trees'):
        shard_of(Scene([PlacedTree('one', fork())]), 0, 2)
