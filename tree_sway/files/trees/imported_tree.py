# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A tree as a file gave it: its shape, its wood, and what the importer had to do to it."""

from __future__ import annotations

from dataclasses import dataclass, replace

from tree_sway.core.tree.plausibility import oddities, refuse_implausible
from tree_sway.core.tree.species import Species
from tree_sway.core.tree.tree import Tree
from tree_sway.errors import inside


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
        """Report what is odd about the tree, one sentence each, as of `oddities`."""
        return oddities(self.tree, self.species)

    def of_species(self, species: Species) -> TreeFile:
        """Return the same tree of another wood, with that species' leaves."""
        return replace(self, tree=replace(self.tree, species=species.key), species=species)

    def checked(self) -> TreeFile:
        """Return the same tree if it can be one, else raise as `refuse_implausible`."""
        with inside(self.source):
            refuse_implausible(self.tree, self.species)
        return self
