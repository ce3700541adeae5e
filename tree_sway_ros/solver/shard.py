# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A scene divided among several solvers, each with its own trees."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tree_sway.core.scene import Scene
from tree_sway.errors import ParameterError


def shard_of(scene: Scene, shard: int = 0, shards: int = 1) -> Scene:
    """
    Return the trees of one shard, from 0 on: consecutive trees, of equal numbers.

    Names and order stay, so that the pose blocks of all shards, one after another, are that of the
    whole. Delays of gusts are from the same place in all shards: the anemometer, or the first tree
    of the scene.

    Raises
    ------
    ParameterError
        A shard that does not exist, or more shards than trees.

    """
    if shards == 1 and shard == 0:
        return scene
    if not 0 <= shard < shards:
        raise ParameterError(
            f'shard {shard} of {shards}', where='shard', cure=f'give 0 to {shards - 1}'
        )
    n = len(scene.trees)
    if shards > n:
        cure = 'ask for fewer, or give the file of a forest or a stand'
        raise ParameterError(f'{shards} shards of {n} trees', where='shards', cure=cure)
    trees = [scene.trees[row] for row in np.array_split(np.arange(n), shards)[shard].tolist()]
    one = scene.trees[0]
    where = scene.anemometer or (one.x, one.y, one.z)
    return replace(scene, trees=trees, anemometer=where)
