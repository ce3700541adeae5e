"""
Leaves on or off, for a command: what they weigh and catch, and how they look.

"""

from __future__ import annotations

import argparse
from typing import Any

import numpy as np

from tree_sway_ros.core.leaves import LeafClusters, foliage_of, leaf_clusters
from tree_sway_ros.core.tree import Tree


def add_leaves_argument(parser: argparse.ArgumentParser) -> None:
    """Add the choice of the season."""
    parser.add_argument("--leaves", choices=("on", "off"), default="off", help="(%(default)s)")


def leaf_settings(tree: Tree, arguments: argparse.Namespace) -> dict[str, Any]:
    """What the leaves change in `SimulatorSettings`; nothing if they are off."""
    if arguments.leaves == "off":
        return {}
    foliage = foliage_of(tree)
    return {"in_leaf": True, "leaf_mass": foliage.mass, "leaf_area": foliage.drag_area}


def drawn_leaves(tree: Tree, arguments: argparse.Namespace) -> LeafClusters | None:
    """Clusters to draw, the same in every picture of a tree; None if the leaves are off."""
    return None if arguments.leaves == "off" else leaf_clusters(tree, np.random.default_rng(0))
