# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Branches cut into key segments: poses stay those of the whole tree."""

from __future__ import annotations

import numpy as np
import pytest
from tree_sway_lab.kinds.kinds import kind_called
from tree_sway_lab.validation.crooked_trees import crooked_tree

from tree_sway.core.scene.make import make_simulator
from tree_sway.core.setup.beams.cutting import CARRIED, cut_tree, pieces_by_turn
from tree_sway.core.species.species import Species

WOOD = Species('w', 'w', 8e9, 900.0, damping_bare=0.05)


@pytest.mark.parametrize('seed', range(6))
def test_a_tree_at_rest_has_every_segment_where_the_file_has_it(seed):
    tree = crooked_tree(seed)
    for model in (60, 'full'):
        poses = make_simulator(tree, WOOD, model=model).place()
        assert poses == pytest.approx(tree.rest_poses, abs=1e-12)


def test_pieces_follow_each_other_and_keep_every_segment():
    tree = crooked_tree(2)
    cut = cut_tree(tree, np.where(np.diff(tree.branch_first) >= 4, 2, 1))
    assert cut.tree.n_branches > tree.n_branches
    assert (cut.tree.start == tree.start[cut.row]).all()
    assert np.bincount(cut.branch, cut.share) == pytest.approx(np.ones(tree.n_branches))
    assert set(cut.tree.branch_names) == set(tree.branch_names)


def test_a_stem_of_many_limbs_is_cut_though_it_does_not_turn():
    tree = kind_called('limbs16')
    pieces = pieces_by_turn(tree, np.zeros(tree.n_branches))
    assert pieces.tolist() == [-(-16 // CARRIED), *[1] * 16]
