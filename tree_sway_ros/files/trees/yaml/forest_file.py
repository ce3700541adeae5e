# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Trees that stand together, as a file gave them; used like a `TreeFile`."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from tree_sway_ros.core.leaves.foliage import (
    foliage_of,
    joined_clusters,
    leaf_clusters,
    LeafClusters,
    no_clusters,
)
from tree_sway_ros.core.scene.forest import Forest
from tree_sway_ros.core.scene.placed_tree import joined, PlacedTree
from tree_sway_ros.core.simulator.settings import Settings
from tree_sway_ros.core.tree.plausibility import doubts
from tree_sway_ros.core.tree.species import Species, species_named
from tree_sway_ros.core.tree.tree import Tree
from tree_sway_ros.errors import FormatError
from tree_sway_ros.files.trees.imported_tree import TreeFile


@dataclass(frozen=True, eq=False)
class ForestFile:
    """
    A forest: its trees, each with its name, its place and its wood.

    Notes say what the importer changed or left out, one sentence each. The wind is measured at the
    ``anemometer`` [m], where it reaches the forest if None; gusts travel at ``convection_ratio``
    times the mean wind speed.
    """

    name: str
    trees: tuple[PlacedTree, ...]
    source: str
    notes: tuple[str, ...] = ()
    anemometer: tuple[float, float, float] | None = None
    convection_ratio: float = 1.0

    @cached_property
    def tree(self) -> Tree:
        """All trees as one record where they stand, named ``tree/branch``, to draw or write."""
        return joined([each.placed() for each in self.trees], self.name)

    @property
    def warnings(self) -> tuple[str, ...]:
        """Tell what is odd about each tree, as `TreeFile.warnings`."""
        return tuple(
            f'{each.name}: {doubt}'
            for each in self.trees
            for doubt in doubts(each.tree, each.species or species_named(each.tree.species))
        )

    def checked(self) -> ForestFile:
        """Return the same forest if every tree's numbers can be those of one."""
        for each in self.trees:
            species = each.species or species_named(each.tree.species)
            TreeFile(each.tree, species, f'{self.source}: {each.name}').checked()
        return self

    def with_trees(self, trees: Sequence[PlacedTree]) -> ForestFile:
        """Return the same forest of some of its trees, which may stand elsewhere."""
        return replace(self, trees=tuple(trees))

    def of_species(self, species: Species) -> ForestFile:
        """Return the same forest, all of one wood."""
        trees = [
            replace(each, tree=replace(each.tree, species=species.key), species=species)
            for each in self.trees
        ]
        return replace(self, trees=tuple(trees))

    def simulator(
        self, settings: Settings | None = None, *, tolerance: float = 0.005, **changes: Any
    ) -> Forest:
        """Make a simulator of all trees, as `make_simulator`; its errors name the tree."""
        return Forest(
            self.trees,
            settings,
            tolerance=tolerance,
            anemometer=self.anemometer,
            convection_ratio=self.convection_ratio,
            **changes,
        )

    def leaves(self, told: bool | None, count: int) -> LeafClusters | None:
        """
        Place so many clusters of leaves, on each tree by its leaf area; None without leaves.

        Whether trees bear leaves of which the file does not say is told, or left to the species by
        None.
        """
        area = np.array(
            [
                foliage_of(each.tree).area.sum() if each.bears_leaves(told) else 0.0
                for each in self.trees
            ]
        )
        if not area.any() or count < 1:
            return None
        counts = np.ceil(count * area / area.sum() - 1e-9).astype(np.int64).tolist()
        clusters = [
            leaf_clusters(each.placed(), np.random.default_rng(number), count=own)
            if own
            else no_clusters()
            for number, (each, own) in enumerate(zip(self.trees, counts, strict=True))
        ]
        return joined_clusters(clusters, [each.tree.n_segments for each in self.trees])


def forest_of_files(files: Sequence[TreeFile], name: str) -> ForestFile:
    """Return the trees of one file as a forest: where they stand there, the first at 0."""
    first = np.array(files[0].origin)
    trees = []
    for each in files:
        x, y, z = (np.array(each.origin) - first + each.tree.start[0]).tolist()
        trees.append(PlacedTree(each.tree.name, each.tree, x, y, z, species=each.species))
    notes = [f'{each.tree.name}: {note}' for each in files for note in each.notes]
    return ForestFile(name, tuple(trees), files[0].source, tuple(notes))


def refuse_same_names(names: Sequence[str], where: Callable[[int], str]) -> None:
    """Raise a `FormatError` for the first tree with a slash in its name, or that of another."""
    first: dict[str, int] = {}
    for number, name in enumerate(names):
        if '/' in name:
            raise FormatError(
                f"a slash in the name '{name}'",
                where=where(number),
                cure='leave it out: it stands between tree and branch in the names of segments',
            )
        if name in first:
            line = where(first[name]).rsplit(':', 1)[1]
            raise FormatError(
                f"two trees called '{name}', the first in line {line}",
                where=where(number),
                cure='give each a name of its own',
            )
        first[name] = number
