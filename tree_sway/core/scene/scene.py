# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A scene: one tree, a forest or a stand of thousands, from a file or from a program."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
import math
from typing import Any

import numpy as np

from tree_sway.core.checks import number_of
from tree_sway.core.leaves import foliage_of, joined_clusters, leaf_clusters, LeafClusters
from tree_sway.core.model import ModelCache, PREPARED
from tree_sway.core.scene.make import make_simulator
from tree_sway.core.scene.placed_tree import Kind
from tree_sway.core.scene.placed_trees import PlacedTrees
from tree_sway.core.scene.scene_simulator import SceneSimulator, Simulator
from tree_sway.core.settings import Settings, settings_with
from tree_sway.core.species import Species
from tree_sway.core.tree import oddities, refuse_implausible
from tree_sway.errors import inside, ParameterError

_MOST_APART = 20
"""Largest number of trees apart from their anemometer, each with a model and a field of gusts."""


@dataclass(frozen=True, eq=False)
class Scene(PlacedTrees):
    """
    Trees in one wind.

    Parameters
    ----------
    trees
        Trees, each with its own name.
    name
        Name of the scene.
    source
        Source: a path, or the name of a built-in tree.
    notes
        Changes and omissions by the importer, one sentence each.
    anemometer
        Place of the anemometer in [m], (3,), best upwind of all trees; by default at the tree that
        the wind reaches first.
    convection_ratio
        Speed at which gusts travel over the mean wind speed in [-]; infinite for one wind
        everywhere.
    faults
        Changes by the importer of what no tree can have, one sentence each.

    Raises
    ------
    ParameterError
        Two trees of one name, or an object that is not a `PlacedTree`.
    TreeError
        A scene without trees.

    Examples
    --------
    >>> row = [PlacedTree(f"oak {i}", oak, x=8.0 * i, scale=0.8 + 0.01 * i) for i in range(40)]
    >>> simulator = Scene(row).simulator(model=20)
    >>> simulator.step((8.0, 0.0, 0.0), 1 / 60)
    0

    """

    def __repr__(self) -> str:
        """Return name, number of trees and of kinds, or the only tree, on one line."""
        if self.is_one_tree:
            return f'Scene {self.name!r}: {self.trees[0]!r}'
        n_kinds = len(self.kinds)
        kinds = '1 kind' if n_kinds == 1 else f'{n_kinds} kinds'
        return f'Scene {self.name!r}: {len(self.trees)} trees of {kinds}'

    @property
    def species(self) -> Species | None:
        """Species of all trees; None where they differ."""
        found = {id(kind.species): kind.species for kind in self.kinds}
        return next(iter(found.values())) if len(found) == 1 else None

    @property
    def warnings(self) -> tuple[str, ...]:
        """Faults of the trees, and implausible values, one sentence per kind each."""
        found = list(self.faults)
        for label, kind in self._labelled():
            found += [f'{label}{oddity}' for oddity in oddities(kind.tree, kind.species)]
        return tuple(found)

    def checked(self) -> Scene:
        """Return the scene if the numbers of every tree are plausible, else raise."""
        for label, kind in self._labelled():
            with inside(f'{self.source}: {label}'.removesuffix(': ')):
                refuse_implausible(kind.tree, kind.species)
        return self

    def of_species(self, species: Species) -> Scene:
        """Return the scene with all trees of one species; nothing was learned of another one."""
        kinds = [replace(kind.tree, species=species.key) for kind in self.kinds]
        trees = [
            replace(
                each,
                tree=kinds[number],
                species=species,
                learned=each.learned if species == each.species else None,
            )
            for each, number in zip(self.trees, self.kind_numbers.tolist(), strict=True)
        ]
        return replace(self, trees=trees)

    def moved(self, x: float = 0.0, y: float = 0.0, z: float = 0.0, yaw: float = 0.0) -> Scene:
        """
        Return the scene with a different origin in [m], rotated about it by yaw [rad].

        The rotation is about the vertical, counterclockwise seen from above.
        """
        for number in (x, y, z, yaw):
            number_of('moved', number)
        if (x, y, z, yaw) == (0.0, 0.0, 0.0, 0.0):
            return self
        c = math.cos(yaw)
        s = math.sin(yaw)

        def there(px: float, py: float, pz: float) -> tuple[float, float, float]:
            return x + c * px - s * py, y + s * px + c * py, z + pz

        trees = []
        for each in self.trees:
            px, py, pz = there(each.x, each.y, each.z)
            trees.append(replace(each, x=px, y=py, z=pz, yaw=each.yaw + yaw))
        anemometer = None if self.anemometer is None else there(*self.anemometer)
        return replace(self, trees=trees, anemometer=anemometer)

    def simulator(
        self,
        settings: Settings | None = None,
        *,
        tolerance: float = 0.005,
        cache: ModelCache | None = PREPARED,
        progress: Callable[[int], object] = lambda done: None,
        **changes: Any,
    ) -> Simulator:
        """
        Make the simulator of the scene: that of its tree, or a `SceneSimulator` of several.

        Parameters
        ----------
        settings, **changes
            Settings of the trees, except values that a tree has itself.
        tolerance, cache
            Arguments of `make_simulator`, for each tree.
        progress
            Function called with the number of kinds and trees that are ready.

        Raises
        ------
        TreeSwayError
            An error of `make_simulator`, with the name of the tree.

        """
        chosen = settings_with(settings, changes)
        if not self.is_one_tree:
            if chosen.is_far and len(self.trees) > _MOST_APART:
                raise ParameterError(
                    f'a distance to the anemometer for {len(self.trees)} trees',
                    where='anemometer_distance',
                    cure=f'leave it out above {_MOST_APART} trees: each needs a model of its own',
                )
            return SceneSimulator(
                self, chosen, tolerance=tolerance, cache=cache, progress=progress
            )
        one, where = self.trees[0], self.settings_of(0, chosen)
        return make_simulator(one.placed(), one.species, where, tolerance=tolerance, cache=cache)

    def leaves(self, in_leaf: bool | None, count: int) -> LeafClusters | None:
        """
        Place clusters of leaves, on each tree by its leaf area; None without leaves.

        ``in_leaf`` is for trees whose leaves the scene does not determine; None is by their
        species.
        """
        kinds = [float(foliage_of(k.tree, traits=k.species.leaves).area.sum()) for k in self.kinds]
        area = np.array(kinds)[self.kind_numbers]
        area *= [each.scale**2 * each.bears_leaves(in_leaf) for each in self.trees]
        if not area.any() or count < 1:
            return None
        counts = np.ceil(count * area / area.sum() - 1e-9).astype(np.int64).tolist()
        clusters = [
            leaf_clusters(
                each.placed(),
                np.random.default_rng(number),
                count=own,
                traits=each.species.leaves,
                look=each.species.look,
            )
            for number, (each, own) in enumerate(zip(self.trees, counts, strict=True))
        ]
        return joined_clusters(clusters, [each.tree.n_segments for each in self.trees])

    def _labelled(self) -> list[tuple[str, Kind]]:
        """Yield each kind, and the beginning of a message about it: the name of its first tree."""
        if self.is_one_tree:
            return [('', self.kinds[0])]
        _, first, counts = np.unique(self.kind_numbers, return_index=True, return_counts=True)
        labels = [
            f'{self.trees[t].name}{f" and {n - 1} more" if n > 1 else ""}: '
            for t, n in zip(first.tolist(), counts.tolist(), strict=True)
        ]
        return list(zip(labels, self.kinds, strict=True))
