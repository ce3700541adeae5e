# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Which branches may be frozen."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from tree_sway_ros.core.fidelity.quiet_branches import quiet_sets
from tree_sway_ros.core.motion.response import key_response, tip_motion
from tree_sway_ros.core.simulator.assembly import CalibratedTree
from tree_sway_ros.core.simulator.settings import Settings
from tree_sway_ros.core.tree.species import species_named
from tree_sway_ros.study.example_trees import forked_tree

FREQUENCIES = np.concatenate([[0.0], np.geomspace(0.05, 20.0, 30)])
SHARES = (1e-6, 0.003, 0.01, 0.03, 0.1, 10.0)


@pytest.fixture(scope='module')
def answer():
    tree = forked_tree(0.4, 0.35)
    whole = CalibratedTree(tree, species_named('oak'), Settings())
    bank = whole.bank('modes', 12)
    rotations = key_response(bank.oscillators, whole.coupled.reduction.n_coordinates, FREQUENCIES)
    return whole, bank.branches, rotations


@pytest.fixture(scope='module')
def sets(answer):
    whole, branches, rotations = answer
    return quiet_sets(whole.tree, branches, rotations, FREQUENCIES, SHARES)


def test_sets_are_nested_from_none_to_all_but_the_stem(sets):
    counts = [int(quiet.sum()) for quiet in sets]
    assert counts[0] == 0
    assert counts[-1] == 39
    assert counts == sorted(counts)
    assert len(set(counts)) >= 4
    for less, more in pairwise(sets):
        assert not np.any(less & ~more)


def test_what_freezing_costs_is_within_its_share(answer, sets):
    """Set keys of the frozen to zero, and look at the tips: in still air, the mean load alone."""
    whole, branches, rotations = answer
    owner = np.repeat(np.arange(whole.tree.n_branches), branches['n_coordinates'])
    static = rotations[:, :, :1].real
    moved = tip_motion(branches, static)
    for quiet, share in zip(sets[:-1], SHARES, strict=False):
        stiff = np.where(quiet[owner, None, None], 0.0, static)
        error = np.square(tip_motion(branches, stiff) - moved).sum() / np.square(moved).sum()
        assert np.sqrt(error) <= 1.2 * share
