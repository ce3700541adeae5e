# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Whether a tree bears leaves; mass, area and damping of its leaves."""

from __future__ import annotations

from dataclasses import replace

from tree_sway.core.settings import Settings
from tree_sway.core.species import Species
from tree_sway.core.tree import Tree

LEAVES: dict[str, bool | None] = {'auto': None, 'on': True, 'off': False}
"""Choices of leaves; with ``auto`` it depends on the species: evergreens bear them."""


def is_in_leaf(species: Species, asked: bool | None = None) -> bool:
    """Return whether a tree bears leaves; if None, evergreen species do."""
    return species.leaves.is_evergreen if asked is None else asked


def in_season(tree: Tree, species: Species, settings: Settings) -> Settings:
    """
    Return the settings with the leaves that the tree of a species bears.

    Leaves add mass and area to their branches, damp them as the species in leaf, and let the crown
    streamline. Given leaves are kept; the result is a fixed point of the function.
    """
    are_given = settings.leaf_mass is not None or settings.leaf_area is not None
    in_leaf = are_given or is_in_leaf(species, settings.in_leaf)
    if are_given or not in_leaf:
        return settings if settings.in_leaf == in_leaf else replace(settings, in_leaf=in_leaf)
    from tree_sway.core.leaves import foliage_of

    leaves = foliage_of(tree, traits=species.leaves)
    return replace(settings, in_leaf=True, leaf_mass=leaves.mass, leaf_area=leaves.drag_area)
