# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
What a frame costs, from counts: known before a model is run, so that a budget can choose.

Prices are fits to trees of 31 to 261 branches in 3 to 12 segments each, timed on one core of a
server of 2020; `pace` scales them to the machine at hand.
"""

from __future__ import annotations

from tree_sway_ros.core.simulator.assembly import Bank
from tree_sway_ros.core.tree.tree import Tree

_CALL = 4.0
"""Of a step, and of placing, however small the tree in [us]."""

_STEP_ALONE, _STEP_CARRIED, _STEP_ENRICHED = 0.06, 0.13, 0.15
"""Of stepping a branch: alone, one that carries or is carried, and what further shapes add."""

_STEP_TABLED = 1.5
"""Of stepping a tree on its table, however large."""

_PLACE_BRANCH, _PLACE_ENRICHED, _PLACE_SEGMENT, _PLACE_RIGID = 0.03, 0.12, 0.013, 0.012
"""Of placing: a branch, what further shapes add, a segment that bends, one that is frozen."""

_MODE_OF_COORDINATE = 1.5e-3
"""Of a mode on a coordinate, stepped and placed."""


def frame_cost(bank: Bank, tree: Tree) -> float:
    """Cost of one step and one placing of a model of a whole tree in [us]."""
    branches = bank.branches
    n_moving, n_enriched = len(branches), int((branches['n_coordinates'] > 2).sum())
    n_bending = int((branches['end'] - branches['first']).sum())
    place = _CALL + _PLACE_BRANCH * n_moving + _PLACE_ENRICHED * n_enriched
    place += _PLACE_SEGMENT * n_bending + _PLACE_RIGID * (tree.n_segments - n_bending)
    if not bank.frequencies.size:
        return place
    each = _STEP_CARRIED if bank.oscillators.carries else _STEP_ALONE
    step = _CALL + each * n_moving + _STEP_ENRICHED * n_enriched
    if bank.oscillators.is_tabled:
        step = _CALL + _STEP_TABLED
    return place + step + _MODE_OF_COORDINATE * bank.oscillators.shapes.size
