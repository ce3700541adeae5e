# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The records of the branches of a tree, for stepping and placing it."""

from __future__ import annotations

import numpy as np

from tree_sway.core.arrays import Floats, Records
from tree_sway.core.model import branch_layout, fill_places, Places
from tree_sway.core.setup.beams.branch_model import BranchModel
from tree_sway.core.setup.fitted_load import fill_loads
from tree_sway.core.setup.matrices import Reduction
from tree_sway.core.tree import Tree


def branch_records(
    tree: Tree,
    models: list[BranchModel],
    reduction: Reduction,
    places: Places,
    speed_profile: Floats,
) -> Records:
    """
    Fill the branches for stepping and placing: records of `branch_layout`, (b,).

    The profile is the wind speed at each segment over that at the anemometer, (n,).
    """
    records = np.zeros(tree.n_branches, dtype=branch_layout(places.segment_turn.shape[1]))
    for alike in _of_one_shape(models):
        own = [models[branch] for branch in alike]
        segments = [tree.branch_first[b] + models[b].beam.segment for b in alike]
        fill_loads(own, speed_profile[np.array(segments)], np.array(alike), records)
    fill_places(places, records)
    records['twist'] = reduction.twist[:, : records['twist'].shape[1]]
    _fill_arms(tree, records)
    return records


def _of_one_shape(models: list[BranchModel]) -> list[list[int]]:
    """Return branches whose arrays have the same shapes together, by their numbers."""
    found: dict[tuple[int, int, bool], list[int]] = {}
    for branch, model in enumerate(models):
        shape = len(model.beam.length), len(model.fields), len(model.children) > 0
        found.setdefault(shape, []).append(branch)
    return list(found.values())


def _fill_arms(tree: Tree, records: Records) -> None:
    """Fill where each branch begins and ends, and its arm from the base of its parent."""
    root = tree.start[0]
    base = tree.start[tree.branch_first[:-1]] - root
    arm = base - base[np.maximum(tree.branch_parent, 0)]
    square = np.square(arm).sum(axis=1)
    records['base'] = base
    records['tip'] = tree.end[tree.branch_first[1:] - 1] - root
    records['arm'] = arm
    records['per_arm'] = np.divide(0.5, square, out=np.zeros_like(square), where=square > 0.0)
