# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A stand as a file gave it: its kinds, and where each tree stands; used like a `ForestFile`."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from tree_sway_ros.core.scene.placed_tree import PlacedTree
from tree_sway_ros.core.scene.stand import scaled_tree, Stand, StandKind, StandTree
from tree_sway_ros.core.simulator.settings import Settings
from tree_sway_ros.core.tree.species import Species
from tree_sway_ros.files.trees.yaml.forest_file import ForestFile


@dataclass(frozen=True, eq=False)
class StandFile(ForestFile):
    """A stand: kinds of trees by name, and each tree with its name, its kind and its place."""

    kinds: dict[str, StandKind] = field(default_factory=dict)
    standing: tuple[StandTree, ...] = ()

    def with_trees(self, trees: Sequence[PlacedTree]) -> StandFile:
        """Return the same stand of some of its trees, which may stand elsewhere."""
        standing = {each.name: each for each in self.standing}
        moved = tuple(
            replace(standing[each.name], x=each.x, y=each.y, z=each.z, yaw=each.yaw)
            for each in trees
        )
        return replace(self, trees=tuple(trees), standing=moved)

    def of_species(self, species: Species) -> StandFile:
        """Return the same stand, all of one wood."""
        kinds = {
            name: StandKind(replace(kind.tree, species=species.key), species)
            for name, kind in self.kinds.items()
        }
        trees = super().of_species(species).trees
        return replace(self, trees=trees, kinds=kinds)

    def simulator(  # type: ignore[override]
        self,
        settings: Settings | None = None,
        *,
        fidelity: str = 'wind_basis',
        tolerance: float = 0.005,
        progress: Callable[[int], object] = lambda done: None,
        **changes: Any,
    ) -> Stand:
        """
        Make a `Stand` of all trees, on the model `wind_basis` but for those that say otherwise.

        ``fidelity`` and ``tolerance`` are not used: they are there for `ForestFile`.
        """
        return Stand(
            self.standing,
            self.kinds,
            settings,
            anemometer=self.anemometer,
            convection_ratio=self.convection_ratio,
            progress=progress,
            **changes,
        )


def stand_file(
    name: str, standing: tuple[StandTree, ...], kinds: dict[str, StandKind], **told: Any
) -> StandFile:
    """Lay a stand out as a file of trees; other arguments are those of `ForestFile`."""
    trees = tuple(
        PlacedTree(
            each.name,
            scaled_tree(kinds[each.kind].tree, each.scale),
            each.x,
            each.y,
            each.z,
            each.yaw,
            species=kinds[each.kind].species,
        )
        for each in standing
    )
    return StandFile(name, trees, kinds=kinds, standing=standing, **told)
