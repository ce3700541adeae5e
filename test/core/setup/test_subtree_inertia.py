# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Inertia with a subtree that gives way: between a stiff one and the coupled tree's frequency."""

from __future__ import annotations

import numpy as np
import pytest

from tree_sway.core.setup.beams.branch_model import TreeBeams
from tree_sway.core.setup.matrices import reduce_tree
from tree_sway.core.setup.modes import natural_modes
from tree_sway.core.setup.subtree_inertia import subtree_inertia


def reduced(tree):
    return reduce_tree(tree, TreeBeams(tree, 900.0).models(subtrees=True), 9e9, 3.5e9, 0.0)


def test_a_twig_that_carries_nothing_keeps_its_own(fork):
    tree = fork()
    matrices = reduced(tree)
    inertia, alone = subtree_inertia(tree, matrices), matrices.mass.diagonal()
    assert inertia[4:] == pytest.approx(alone[4:])
    # Both axes count as one.
    both, both_alone = inertia.reshape(-1, 2).mean(axis=1), alone.reshape(-1, 2).mean(axis=1)
    assert (both >= both_alone * (1 - 1e-12)).all()


def test_it_brings_the_stem_nearer_to_the_coupled_trees_pace(sketch):
    drawn = sketch()
    drawn.add(None, 0, (0, 0, 1), 2.0, 0.02, 0.012, 6)
    for side in (1.0, -1.0):
        drawn.add(0, 4, (side, 0.3, 0.5), 1.0, 0.010, 0.005, 4)
    tree = drawn.tree()
    matrices = reduced(tree)
    # It is the same about both axes.
    truth = natural_modes(tree, matrices, 2).circular.mean()
    stiff = matrices.stiffness.diagonal()[:2].mean()
    rigid = np.sqrt(stiff / matrices.mass.diagonal()[:2].mean())
    giving = np.sqrt(stiff / subtree_inertia(tree, matrices)[:2].mean())
    assert abs(giving / truth - 1.0) < 0.5 * abs(rigid / truth - 1.0)


def test_stiff_branches_give_no_way(sketch):
    drawn = sketch()
    drawn.add(None, 0, (0, 0, 1), 2.0, 0.01, 0.01, 4)
    drawn.add(0, 4, (1, 0, 0), 0.1, 0.1, 0.1, 1)
    tree = drawn.tree()
    matrices = reduced(tree)
    inertia, alone = subtree_inertia(tree, matrices), matrices.mass.diagonal()
    assert inertia[:2].mean() == pytest.approx(alone[:2].mean(), rel=1e-3)
    assert inertia[2:] == pytest.approx(alone[2:], rel=1e-3)
