# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Trees at their places: turned and moved, with no other change; joined to one record."""

from __future__ import annotations

from dataclasses import replace

from drawn_trees import branch_order
import numpy as np
import pytest

from tree_sway.core.scene.placed_tree import joined, PlacedTree
from tree_sway.core.settings import Settings
from tree_sway.core.wind.height_profile import WindProfile
from tree_sway.errors import ParameterError, TreeError


def test_a_tree_is_turned_about_its_root_and_moved(fork):
    tree = fork()
    placed = PlacedTree('oak', tree, x=3.0, y=-2.0, z=1.0, yaw=np.pi / 2).placed()
    assert placed.name == 'oak'
    assert placed.start[0] == pytest.approx([3.0, -2.0, 1.0])
    way, turned = tree.end - tree.start[0], placed.end - placed.start[0]
    # A quarter turn to the left: east becomes north.
    assert turned == pytest.approx(np.stack([-way[:, 1], way[:, 0], way[:, 2]], axis=1))
    assert placed.length == pytest.approx(tree.length)
    assert (placed.segment_parent == tree.segment_parent).all()


def test_the_wind_profile_counts_from_the_ground_below_it(fork):
    forest = Settings(profile=WindProfile('power', ground=0.5))
    tree = PlacedTree('hill', fork(), z=20.0)
    assert tree.settings_where_it_stands(forest).profile == WindProfile('power', ground=20.5)
    own = PlacedTree('own', fork(), model='branch')
    assert own.settings_where_it_stands(forest) == replace(forest, model='branch')


def test_joined_trees_keep_their_order_and_names(fork, stem):
    trees = [
        PlacedTree('a', fork()).placed(),
        PlacedTree('b', stem(species='oak'), x=5.0).placed(),
    ]
    both = joined(trees, 'park')
    n, b = trees[0].n_segments, trees[0].n_branches
    assert (both.name, both.species) == ('park', 'mixed')
    assert both.n_segments == n + trees[1].n_segments
    assert both.segment_names[0] == 'a/stem/0'
    assert both.segment_names[n] == 'b/stem/0'
    assert (np.flatnonzero(both.segment_parent < 0) == [0, n]).all()
    assert both.segment_parent[n + 1] == n
    assert both.branch_parent[b] == -1
    assert (both.branch_of_segment[n:] == b).all()
    assert branch_order(both)[b] == 0
    assert both.subtree_end.tolist() == [*trees[0].subtree_end, b + 1]
    for field in ('start', 'end', 'base_diameter', 'tip_diameter', 'length'):
        parts = np.concatenate([getattr(tree, field) for tree in trees])
        assert (getattr(both, field) == parts).all()


def test_no_trees_cannot_be_joined():
    with pytest.raises(TreeError, match='no trees'):
        joined([])


@pytest.mark.parametrize('pose', [{'x': np.nan}, {'z': np.inf}, {'yaw': np.nan}])
def test_a_tree_that_is_nowhere_is_refused(fork, pose):
    with pytest.raises(ParameterError, match='oak'):
        PlacedTree('oak', fork(), **pose)
