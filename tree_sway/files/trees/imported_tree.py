# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A tree of a file: its shape, its species, and changes by the importer."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any

from tree_sway.core.species import Species
from tree_sway.core.tree import oddities, refuse_implausible, Tree
from tree_sway.drawn import Drawn
from tree_sway.errors import inside
from tree_sway.twin import LearnedTree


def said_of(files: Iterable[tuple[str, TreeFile]]) -> dict[str, Any]:
    """Return ``notes`` and ``faults`` of trees, each behind the name that its tree has."""
    named = list(files)
    return {
        kind: tuple(f'{name}: {text}' for name, file in named for text in getattr(file, kind))
        for kind in ('notes', 'faults')
    }


@dataclass(frozen=True, eq=False)
class TreeFile(Drawn):
    """
    A tree with its species.

    Parameters
    ----------
    tree
        Tree of the segments.
    species
        Wood, damping and drag: the table's entry for ``tree.species``, with values of the file in
        place of those of the table.
    source
        Source: a path, or the name of a built-in tree.
    notes : tuple of str
        Changes and omissions by the importer, one sentence each.
    faults : tuple of str
        Changes of what no tree can have, one sentence each.
    origin
        Origin of the tree in the frame of the file in [m].
    learned
        Findings of motion sensors, which its species already has; None without.

    """

    tree: Tree
    species: Species
    source: str
    notes: tuple[str, ...] = ()
    faults: tuple[str, ...] = ()
    origin: tuple[float, float, float] = (0.0, 0.0, 0.0)
    learned: LearnedTree | None = None

    def __repr__(self) -> str:
        """Return the tree and its source on one line."""
        return f'TreeFile {self.source!r}: {self.tree!r}'

    @property
    def warnings(self) -> tuple[str, ...]:
        """Report faults and unusual values of the tree (`oddities`), one sentence each."""
        return (*self.faults, *oddities(self.tree, self.species))

    def of_species(self, species: Species) -> TreeFile:
        """Return the tree with a species and its leaves; nothing was learned of another one."""
        tree = replace(self.tree, species=species.key)
        learned = self.learned if species == self.species else None
        return replace(self, tree=tree, species=species, learned=learned)

    def checked(self) -> TreeFile:
        """Return the tree if it is plausible, else raise as `refuse_implausible`."""
        with inside(self.source):
            refuse_implausible(self.tree, self.species)
        return self
