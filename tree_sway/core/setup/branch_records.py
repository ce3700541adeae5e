# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The records of the branches of a tree, for stepping and placing it."""

from __future__ import annotations

import numpy as np

from tree_sway.core.arrays import Floats, Records
from tree_sway.core.model import branches_at_rest
from tree_sway.core.setup.beams.branch_model import BranchModel
from tree_sway.core.setup.branch_places import Places
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
    Fill the branches for stepping and placing, records of `Branch`, (b,).

    The profile is the wind speed at each segment over that at the anemometer, (n,).
    """
    room = places.segment_turn.shape[1]
    records = branches_at_rest(tree, places.parent, places.first, room)
    for alike in _of_one_shape(models):
        own = [models[branch] for branch in alike]
        segments = [tree.branch_first[b] + models[b].beam.segment for b in alike]
        fill_loads(own, speed_profile[np.array(segments)], np.array(alike), records)
    for name in ('base_segment', 'coordinate', 'n_coordinates', 'frame', 'offset'):
        records[name] = getattr(places, name)
    records['twist'] = reduction.twist[:, : records['twist'].shape[1]]
    return records


def _of_one_shape(models: list[BranchModel]) -> list[list[int]]:
    """Return branches whose arrays have the same shapes together, by their numbers."""
    found: dict[tuple[int, int, bool], list[int]] = {}
    for branch, model in enumerate(models):
        shape = len(model.beam.length), len(model.fields), len(model.children) > 0
        found.setdefault(shape, []).append(branch)
    return list(found.values())
