# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What is left of a tree when subtrees are frozen."""

from __future__ import annotations

import numpy as np
import pytest

from tree_sway_ros.core.motion.fill_records import moving_records
from tree_sway_ros.core.motion.numpy_passes import even_wind_moments
from tree_sway_ros.core.reduction.pruning import Pruning
from tree_sway_ros.core.simulator.assembly import CalibratedTree
from tree_sway_ros.core.simulator.settings import Settings
from tree_sway_ros.core.tree.species import species_named
from tree_sway_ros.study.example_trees import forked_tree

OAK = species_named('oak')


@pytest.fixture(scope='module')
def whole():
    return CalibratedTree(forked_tree(0.5, 0.6), OAK, Settings())


def twigs_of(tree):
    return tree.subtree_end - np.arange(tree.n_branches) == 1


def test_with_a_branch_goes_all_it_carries_and_the_stem_stays(fork):
    tree = fork()
    limb = int(np.flatnonzero(tree.branch_parent > 0)[0])
    frozen = np.zeros(tree.n_branches, bool)
    frozen[[0, tree.branch_parent[limb]]] = True
    pruning = Pruning(tree, frozen)
    assert pruning.frozen[limb]
    assert not pruning.frozen[0]
    assert list(pruning.tops) == [tree.branch_parent[limb]]
    assert pruning.carriers()[limb] == 0


def test_the_moving_branches_are_a_tree(whole):
    pruning = Pruning(whole.tree, twigs_of(whole.tree))
    tree = pruning.tree()
    assert tree.n_branches == len(pruning.moving) == 13
    assert tree.branch_parent[0] == -1
    assert np.all(tree.branch_parent[1:] < np.arange(1, 13))
    sits_on = tree.branch_of_segment[tree.segment_parent[tree.branch_first[1:-1]]]
    np.testing.assert_array_equal(sits_on, tree.branch_parent[1:])
    assert list(tree.subtree_end[[0, 1]]) == [13, 5]
    assert tree.branch_names[4] == whole.tree.branch_names[pruning.moving[4]]


def test_matrices_lose_rows_and_nothing_else(whole):
    pruning, full = Pruning(whole.tree, twigs_of(whole.tree)), whole.coupled.reduction
    keep, left = pruning.coordinates(full), pruning.reduction(full)
    assert left.n_coordinates == len(keep) == full.n_coordinates - 2 * 27
    np.testing.assert_array_equal(left.mass.toarray(), full.mass.toarray()[np.ix_(keep, keep)])
    elastic = full.elastic.toarray()[np.ix_(keep, keep)]
    np.testing.assert_array_equal(left.elastic.toarray(), elastic)


def test_an_even_wind_pushes_as_hard_as_before(whole):
    """Drag of branches to all sides as one load: within 2 percent, mean of its parts 6."""
    pruning, full = Pruning(whole.tree, twigs_of(whole.tree)), whole.coupled
    records = moving_records(pruning, full.branches)
    n, keep = full.reduction.n_coordinates, pruning.coordinates(full.reduction)
    before = even_wind_moments(full.branches, n)[keep]
    after = even_wind_moments(records, len(keep))
    stem = slice(0, 2)
    assert np.abs(after - before)[stem].max() <= 0.02 * np.abs(before[stem]).max()
    assert np.abs(after - before).max() <= 0.06 * np.abs(before).max()


def test_no_wind_area_no_load(whole):
    bare = whole.coupled.branches.copy()
    bare['area'] = 0.0
    records = moving_records(Pruning(whole.tree, twigs_of(whole.tree)), bare)
    np.testing.assert_array_equal(records['push'], bare['push'][~twigs_of(whole.tree)])
