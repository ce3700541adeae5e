"""
Leaves on or off, for a command: what they weigh and catch, and how they look.

"""

from __future__ import annotations

import argparse
from typing import Any

from tree_sway_ros.core.leaves.foliage import LeafClusters, foliage_of
from tree_sway_ros.core.tree.tree import Tree
from tree_sway_ros.files.trees.imported_tree import TreeFile
from tree_sway_ros.files.trees.yaml.forest_file import ForestFile

_DRAWN = 1500


def add_leaves_argument(parser: argparse.ArgumentParser) -> None:
    """Add the choice of the season; ``--leaves`` alone is on."""
    parser.add_argument(
        "--leaves",
        nargs="?",
        choices=("on", "off"),
        const="on",
        default="off",
        help="in leaf; those of a forest where its file does not say (%(default)s)",
    )


def leaves_are_on(arguments: argparse.Namespace) -> bool:
    """Whether the season is that of leaves."""
    return bool(arguments.leaves == "on")


def leaf_settings(tree: Tree, arguments: argparse.Namespace) -> dict[str, Any]:
    """What the leaves change in `Settings`; nothing if they are off."""
    if not leaves_are_on(arguments):
        return {}
    foliage = foliage_of(tree)
    return {"in_leaf": True, "leaf_mass": foliage.mass, "leaf_area": foliage.drag_area}


def drawn_leaves(
    scene: TreeFile | ForestFile, arguments: argparse.Namespace
) -> LeafClusters | None:
    """Clusters to draw, the same in every picture of a tree; None if there are none."""
    return scene.leaves(leaves_are_on(arguments), _DRAWN)
