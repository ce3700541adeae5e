# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Frozen subtrees, placed as one body, against the placing of branches that do not bend."""

from __future__ import annotations

import numpy as np
import pytest

from tree_sway_ros.core.motion.placing import place
from tree_sway_ros.core.simulator.assembly import CalibratedTree
from tree_sway_ros.core.simulator.partly_frozen import PartlyFrozenTree
from tree_sway_ros.core.simulator.settings import Settings
from tree_sway_ros.core.tree.species import species_named
from tree_sway_ros.study.example_trees import forked_tree

pytestmark = pytest.mark.compiled

OAK = species_named('oak')


@pytest.mark.parametrize('model', ['subtree', 'coupled'])
def test_as_branches_whose_keys_are_zero(model):
    tree = forked_tree(0.5, 0.6)
    whole = CalibratedTree(tree, OAK, Settings())
    frozen = np.random.default_rng(2).random(tree.n_branches) < 0.3
    pruned = PartlyFrozenTree(whole, frozen)
    full, part = whole.bank(model), pruned.bank(model)
    keep = pruned.pruning.coordinates(whole.layer(model).reduction)
    assert 0 < part.n_frozen < tree.n_branches - 1
    x = np.zeros(whole.layer(model).reduction.n_coordinates)
    x[keep] = np.random.default_rng(3).normal(0.0, 0.1, len(keep))
    expected, found = np.zeros((2, tree.n_segments, 7))
    place(full.branches, full.segments, full.heads, full.bases, x, tree.start[0], expected)
    bases = part.bases
    place(part.branches, part.segments, part.heads, bases, x[keep], tree.start[0], found)
    part.frozen.place(part.branches, bases, x[keep], found)
    sign = np.sign((expected[:, 3:] * found[:, 3:]).sum(axis=1))[:, None]
    np.testing.assert_allclose(found[:, :3], expected[:, :3], atol=1e-12)
    np.testing.assert_allclose(sign * found[:, 3:], expected[:, 3:], atol=1e-12)
