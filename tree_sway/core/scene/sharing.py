# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Which trees of a scene share the table of their kind, and which have a model of their own."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.arrays import Ints
from tree_sway.core.model.settings import Settings
from tree_sway.core.scene.placed_trees import PlacedTrees


@dataclass(frozen=True)
class Sharing:
    """
    The tables of a scene, and the trees on them.

    Parameters
    ----------
    is_shared
        Whether each tree is on a shared table, (t,).
    counts
        Number of coordinates that each tree asks for, (t,); -1 for a model that has a name.
    kinds
        Kinds of trees with a table, (k,), rising.
    tables
        Row of each tree's kind among them, (t,); -1 for a tree on its own model.

    """

    is_shared: NDArray[np.bool_]
    counts: Ints
    kinds: Ints
    tables: Ints

    def trees_on(self, table: int) -> Ints:
        """Return the numbers of the trees on a table."""
        return np.flatnonzero(self.tables == table)

    @property
    def alone(self) -> Ints:
        """Return the numbers of the trees on models of their own."""
        return np.flatnonzero(~self.is_shared)

    def size_of(self, table: int) -> int:
        """Return the number of coordinates of a table: the most that its trees ask for."""
        return int(self.counts[self.trees_on(table)].max()) or 1


def sharing_of(scene: PlacedTrees, settings: Settings) -> Sharing:
    """Find the trees that share tables: all on a number of coordinates, in crowns of one wind."""
    models = [settings.model if each.model is None else each.model for each in scene.trees]
    counts = np.array([each if isinstance(each, int) else -1 for each in models])
    # The winds of limbs differ from tree to tree.
    is_shared = (counts >= 0) & (not settings.has_limb_winds)
    kinds = np.unique(scene.kind_numbers[is_shared])
    tables = np.where(is_shared, np.searchsorted(kinds, scene.kind_numbers), -1)
    return Sharing(is_shared, counts, kinds, tables)
