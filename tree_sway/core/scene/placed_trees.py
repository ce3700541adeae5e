# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Trees that are placed in one frame, and their kinds."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
import math
from zlib import crc32

import numpy as np

from tree_sway.core.arrays import Ints
from tree_sway.core.scene.placed_tree import joined, Kind, MOST_SEGMENTS, PlacedTree
from tree_sway.core.settings import MOST_SEED, Settings
from tree_sway.core.tree import Tree
from tree_sway.errors import ParameterError, TreeError


@dataclass(frozen=True, eq=False)
class PlacedTrees:
    """
    The trees of a scene, the place of its anemometer, and its source.

    Parameters and errors are those of `Scene`.
    """

    trees: Sequence[PlacedTree]
    name: str = 'scene'
    source: str = ''
    notes: tuple[str, ...] = ()
    anemometer: tuple[float, float, float] | None = None
    convection_ratio: float = 1.0
    faults: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        """Check the trees."""
        if not isinstance(self.trees, Iterable):
            what = f'a {type(self.trees).__name__}, where a list of trees is expected'
            raise ParameterError(what, where='trees', cure='give [PlacedTree(name, tree, x, y)]')
        object.__setattr__(self, 'trees', tuple(self.trees))
        if not self.trees:
            raise TreeError('no trees', where=self.name, cure='give at least one')
        for number, each in enumerate(self.trees):
            if not isinstance(each, PlacedTree):
                what = f'a {type(each).__name__}, where a PlacedTree is expected'
                cure = 'give PlacedTree(name, tree, x, y) each'
                raise ParameterError(what, where=f'trees[{number}]', cure=cure)
        name, count = Counter(each.name for each in self.trees).most_common(1)[0]
        if count > 1:
            raise ParameterError(
                f"{count} trees called '{name}'", where=self.name, cure='give each its own name'
            )

    @cached_property
    def tree(self) -> Tree:
        """
        All trees as one record where they are, named ``tree/branch``; one tree as it is.

        A `ParameterError` for more than `MOST_SEGMENTS`.
        """
        if self.is_one_tree:
            return self.trees[0].placed()
        n_segments = sum(each.tree.n_segments for each in self.trees)
        if n_segments > MOST_SEGMENTS:
            what = f'{n_segments} segments in one record'
            cure = f'at most {MOST_SEGMENTS}: place or draw a part of the trees'
            raise ParameterError(what, where=self.name, cure=cure)
        return joined([each.placed() for each in self.trees], self.name)

    def settings_of(self, number: int, settings: Settings) -> Settings:
        """
        Return the settings of a tree where it stands, and apart from the anemometer.

        A distance with a bearing is that of the first tree, unless the place of the anemometer is
        known. Trees of one seed meet gusts of their own.
        """
        tree, one = self.trees[number], self.trees[0]
        own = tree.settings_where_it_stands(settings)
        distance, bearing, place = own.anemometer_distance, own.anemometer_bearing, self.anemometer
        if not self.is_one_tree:
            if not own.is_far:
                return own
            seed = (own.gust_seed + crc32(tree.name.encode())) % MOST_SEED
            own = replace(own, gust_seed=seed)
            if bearing is not None and place is None:
                away = distance * math.sin(bearing), distance * math.cos(bearing)
                place = one.x + away[0], one.y + away[1], one.z
            if bearing is None:
                return own
        elif distance > 0.0:
            return own
        if place is None:
            return own
        east, north = place[0] - tree.x, place[1] - tree.y
        return replace(
            own,
            anemometer_distance=math.hypot(east, north),
            anemometer_bearing=math.atan2(east, north),
        )

    @property
    def is_one_tree(self) -> bool:
        """Whether the scene has a single tree."""
        return len(self.trees) == 1

    @cached_property
    def _sorted(self) -> tuple[list[Kind], Ints]:
        # By identity, not by equality: trees are large.
        keys = [(id(each.tree), id(each.species), each.leaf_on) for each in self.trees]
        kinds = {key: each.kind for key, each in zip(keys[::-1], self.trees[::-1], strict=True)}
        order = {key: number for number, key in enumerate(dict.fromkeys(keys))}
        return [kinds[key] for key in order], np.array([order[key] for key in keys])

    @property
    def kinds(self) -> list[Kind]:
        """The kinds of trees, in the order of their first."""
        return self._sorted[0]

    @property
    def kind_numbers(self) -> Ints:
        """Number of each tree's kind, (t,)."""
        return self._sorted[1]
