# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A tree as a file gave it: its shape, its wood, and what the importer had to do to it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from tree_sway_ros.core.leaves.foliage import leaf_clusters, LeafClusters
from tree_sway_ros.core.scene.make import make_simulator
from tree_sway_ros.core.simulator.assembly import Kept
from tree_sway_ros.core.simulator.protocol import TreeSimulator
from tree_sway_ros.core.simulator.season import is_in_leaf
from tree_sway_ros.core.simulator.settings import Settings, settings_with
from tree_sway_ros.core.tree.plausibility import doubts, refuse_nonsense
from tree_sway_ros.core.tree.species import Species
from tree_sway_ros.core.tree.tree import Tree
from tree_sway_ros.errors import TreeSwayError


@dataclass(frozen=True, eq=False)
class TreeFile:
    """
    A tree with the species it is made of.

    Parameters
    ----------
    tree
        The segments, in branches.
    species
        Wood, damping and drag: the table's entry for ``tree.species``, with what the file says
        otherwise in place of the table's values.
    source
        Where it came from: a path, or the name of a built-in tree.
    notes : tuple of str
        What the importer changed or left out, one sentence each; empty if nothing.
    origin
        Where the tree's zero is in the frame of the file in [m].

    """

    tree: Tree
    species: Species
    source: str
    notes: tuple[str, ...] = ()
    origin: tuple[float, float, float] = (0.0, 0.0, 0.0)

    @property
    def warnings(self) -> tuple[str, ...]:
        """Tell what is odd about the tree, one sentence each, as of `doubts`."""
        return doubts(self.tree, self.species)

    def of_species(self, species: Species) -> TreeFile:
        """Return the same tree of another wood, with that species' leaves."""
        return replace(self, tree=replace(self.tree, species=species.key), species=species)

    def checked(self) -> TreeFile:
        """Return the same tree if it can be one, else raise as `refuse_nonsense`."""
        try:
            refuse_nonsense(self.tree, self.species)
        except TreeSwayError as error:
            raise error.inside(self.source) from None
        return self

    def simulator(
        self,
        settings: Settings | None = None,
        *,
        tolerance: float = 0.005,
        kept: Kept | None = None,
        **changes: Any,
    ) -> TreeSimulator:
        """Make a simulator of the tree; arguments and errors are those of `make_simulator`."""
        model = settings_with(settings, changes)
        return make_simulator(self.tree, self.species, model, tolerance=tolerance, kept=kept)

    def leaves(self, told: bool | None, count: int) -> LeafClusters | None:
        """
        Place so many clusters of leaves on it, always the same ones; None without leaves.

        Whether it bears them is told, or left to the species by None.
        """
        if not is_in_leaf(self.species, told) or count < 1:
            return None
        return leaf_clusters(
            self.tree, np.random.default_rng(0), count=count, traits=self.species.leaves
        )
