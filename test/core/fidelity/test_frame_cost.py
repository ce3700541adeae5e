# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Costs that are known before a model runs."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from tree_sway_ros.core.fidelity.frame_cost import frame_cost
from tree_sway_ros.core.simulator.assembly import CalibratedTree
from tree_sway_ros.core.simulator.partly_frozen import PartlyFrozenTree
from tree_sway_ros.core.simulator.settings import Settings
from tree_sway_ros.core.tree.species import species_named
from tree_sway_ros.study.example_trees import forked_tree


@pytest.fixture(scope='module')
def whole():
    return CalibratedTree(forked_tree(0.5, 0.6), species_named('oak'), Settings())


def test_richer_models_cost_more(whole):
    models = (
        ('frozen', None),
        ('branch', None),
        ('subtree', None),
        ('modes', 6),
        ('coupled', None),
    )
    costs = [frame_cost(whole.bank(*model), whole.tree) for model in models]
    assert all(less < more for less, more in pairwise(costs))


def test_what_is_frozen_costs_little(whole):
    twigs = whole.tree.subtree_end - np.arange(whole.tree.n_branches) == 1
    bank = PartlyFrozenTree(whole, twigs).bank('modes', 6)
    assert frame_cost(bank, whole.tree) < 0.8 * frame_cost(whole.bank('modes', 6), whole.tree)
