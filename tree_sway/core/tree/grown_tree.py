# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A tree with its species, which functions of a tree accept as well."""

from __future__ import annotations

from dataclasses import replace
import math
from typing import Protocol, runtime_checkable

from tree_sway.core.species import Species, species_named, typical_root_stiffness
from tree_sway.core.tree.plausibility import refuse_no_metres
from tree_sway.core.tree.tree import Tree
from tree_sway.errors import ParameterError


@runtime_checkable
class GrownTree(Protocol):
    """A tree with its species, as `open_tree` returns it."""

    @property
    def tree(self) -> Tree:
        """Return the tree."""

    @property
    def species(self) -> Species:
        """Return the species."""


def tree_and_species(
    tree: Tree | GrownTree, species: Species | None = None
) -> tuple[Tree, Species]:
    """
    Return a tree and its species: the given one, else its own, else that of the table.

    Raises
    ------
    ParameterError
        If one of the two has a wrong type.
    SpeciesError
        A species that no table knows.
    TreeError
        A tree whose size is not in metres.

    """
    if not isinstance(tree, Tree):
        if isinstance(tree, GrownTree):
            return tree_and_species(tree.tree, tree.species if species is None else species)
        what = f'a {type(tree).__name__}, where a tree is expected'
        cure = 'give the result of open_tree, grow or tree_from_segments'
        raise ParameterError(what, where='tree', cure=cure)
    refuse_no_metres(tree)
    if species is None:
        return tree, species_named(tree.species)
    if not isinstance(species, Species):
        what = f'a {type(species).__name__}, where a Species is expected'
        cure = "leave it out or give species_named('oak'); settings go in as settings=..."
        raise ParameterError(what, where='species', cure=cure)
    return tree, species


def rooted(tree: Tree, species: Species) -> Species:
    """Return the species with typical roots of the size of a grown tree, unless it has its own."""
    if species.habit == 'pot' or math.isfinite(species.root_stiffness):
        return species
    stem = species.density * float(tree.volume[tree.segments_of(0)].sum())
    # Three digits are more than the uncertainty of any soil.
    return replace(species, root_stiffness=float(f'{typical_root_stiffness(stem):.3g}'))
