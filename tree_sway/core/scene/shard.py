# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A scene dealt over several solvers, each of which has its own trees and no others."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tree_sway.core.scene.scene import Scene
from tree_sway.errors import ParameterError


def dealt(scene: Scene, shard: int = 0, shards: int = 1) -> Scene:
    """
    Return the trees of one shard, from 0 on: a run of the scene's, of about as many segments.

    Names and order are kept, so that the pose blocks of all shards, one after another, are that of
    the whole. All time gusts from one place: the anemometer, or the first tree of the scene.

    Raises
    ------
    ParameterError
        A shard that does not exist, a scene of one tree, or more shards than trees.

    """
    if shards == 1 and shard == 0:
        return scene
    if not 0 <= shard < shards:
        raise ParameterError(
            f'shard {shard} of {shards}', where='shard', cure=f'give 0 to {shards - 1}'
        )
    if scene.is_one_tree:
        raise ParameterError(
            f"'{scene.name}' is one tree",
            where='shards',
            cure='leave shards at 1, or give the file of a forest or a stand',
        )
    n = len(scene.trees)
    if shards > n:
        raise ParameterError(f'{shards} shards of {n} trees', where='shards', cure='ask for fewer')
    reached = np.cumsum([each.tree.n_segments for each in scene.trees])
    marks = reached[-1] * np.arange(shards + 1) / shards
    cuts = np.searchsorted(reached, marks[1:-1]) + 1
    # None is left without a tree, however large its neighbours are.
    order = np.arange(1, shards)
    cuts = np.maximum.accumulate(np.maximum(cuts, order) - order) + order
    cuts = np.minimum(cuts, n - shards + order)
    first, end = [0, *cuts.tolist(), n][shard : shard + 2]
    one = scene.trees[0]
    where = scene.anemometer or (one.x, one.y, one.z)
    return replace(scene, trees=scene.trees[first:end], anemometer=where)
