"""A tree as a file gave it: its shape, its wood, and what the importer had to do to it."""

from __future__ import annotations

from dataclasses import dataclass

from tree_sway_ros.core.species import Species
from tree_sway_ros.core.tree import Tree


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
    notes
        What the importer changed or left out, one sentence each; empty if nothing.
    origin
        Where the tree's zero is in the frame of the file in [m].

    """

    tree: Tree
    species: Species
    source: str
    notes: tuple[str, ...] = ()
    origin: tuple[float, float, float] = (0.0, 0.0, 0.0)
