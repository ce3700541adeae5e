# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Branches cut into key segments: poses stay those of the whole tree."""

from __future__ import annotations

from drawn_trees import crooked, Sketch, towards, UP, WOOD
import numpy as np
import pytest
from simulators import FULL

from tree_sway.core.scene.make import make_simulator
from tree_sway.core.setup.beams.cutting import CARRIED, cut_tree, pieces_by_turn


@pytest.mark.parametrize('model', [6, *FULL])
def test_a_tree_at_rest_has_every_segment_where_the_file_has_it(model):
    for seed in range(3):
        tree = crooked(seed, 8)
        poses = make_simulator(tree, WOOD, model=model).place()
        assert poses == pytest.approx(tree.rest_poses, abs=1e-12)


def test_pieces_follow_each_other_and_keep_every_segment():
    tree = crooked(2, 20)
    cut = cut_tree(tree, np.where(np.diff(tree.branch_first) >= 4, 2, 1))
    assert cut.tree.n_branches > tree.n_branches
    assert (cut.tree.start == tree.start[cut.row]).all()
    assert np.bincount(cut.branch, cut.share) == pytest.approx(np.ones(tree.n_branches))
    assert set(cut.tree.branch_names) == set(tree.branch_names)


def test_a_stem_of_many_limbs_is_cut_though_it_does_not_turn():
    to = Sketch()
    to.shoot(None, 0, UP, 8.0, 0.16, 0.04, 16)
    for k in range(16):
        to.shoot(0, 5 + k * 11 // 16, towards(137.5 * k, 30.0), 2.0, 0.05, 0.02, 6)
    tree = to.tree()
    pieces = pieces_by_turn(tree, np.zeros(tree.n_branches))
    assert pieces.tolist() == [-(-16 // CARRIED), *[1] * 16]
