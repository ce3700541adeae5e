# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Leaves of a command's trees: whether they bear any, and how they look.

"""

from __future__ import annotations

import argparse

from tree_sway_ros.core.leaves.foliage import LeafClusters
from tree_sway_ros.core.simulator.season import LEAVES
from tree_sway_ros.files.trees.imported_tree import TreeFile
from tree_sway_ros.files.trees.yaml.forest_file import ForestFile

_DRAWN = 1500


def add_leaves_argument(parser: argparse.ArgumentParser) -> None:
    """Add the choice of leaves; ``--leaves`` alone is on."""
    parser.add_argument(
        "--leaves",
        nargs="?",
        choices=tuple(LEAVES),
        const="on",
        default="auto",
        help="in leaf; auto is in leaf where the species is evergreen; of a forest, those trees of "
        "which its file does not say (%(default)s)",
    )


def told_leaves(arguments: argparse.Namespace) -> bool | None:
    """Whether trees bear leaves; None leaves it to their species."""
    return LEAVES[arguments.leaves]


def drawn_leaves(
    scene: TreeFile | ForestFile, arguments: argparse.Namespace
) -> LeafClusters | None:
    """Clusters to draw, the same in every picture of a tree; None if there are none."""
    return scene.leaves(told_leaves(arguments), _DRAWN)
