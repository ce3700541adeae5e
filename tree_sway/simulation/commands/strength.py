# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Trees of a scene whose used strength commands report: the tallest of each kind."""

from __future__ import annotations

from dataclasses import replace

from tree_sway.core.scene import PlacedTree, Scene
from tree_sway.core.settings import Settings
from tree_sway.simulation import Rig


def tallest_of_kinds(scene: Scene) -> dict[int, PlacedTree]:
    """Return the tallest tree of each kind by the number of the kind."""
    by_height = sorted(range(len(scene.trees)), key=lambda row: scene.trees[row].scale)
    return {int(scene.kind_numbers[row]): scene.trees[row] for row in by_height}


def strength_rig(tree: PlacedTree, settings: Settings) -> Rig:
    """
    Set up a tree at its height and in its own size, for its used strength.

    The wind blows along the axis x of the tree itself: trees of an inventory have random yaws, and
    a crown bends its stem by some hundredths more or less from different sides.
    """
    unturned = replace(tree, yaw=0.0).placed()
    at_place = PlacedTree(tree.name, unturned, species=tree.species)
    in_leaf = settings.in_leaf if tree.leaf_on is None else tree.leaf_on
    return Rig(at_place, replace(settings, in_leaf=in_leaf))
