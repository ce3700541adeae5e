# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A scene moved as one: the frame of its file put somewhere in a larger frame."""

from __future__ import annotations

from dataclasses import replace
import math

from tree_sway_ros.core.scene.placed_tree import PlacedTree
from tree_sway_ros.files.trees.imported_tree import TreeFile
from tree_sway_ros.files.trees.yaml.forest_file import ForestFile

Scene = TreeFile | ForestFile


def placed_scene(
    source: Scene, *, x: float = 0.0, y: float = 0.0, z: float = 0.0, yaw: float = 0.0
) -> Scene:
    """
    Return a tree or a forest, in the frame of its file, where that frame's origin lies in [m].

    The frame is turned about the vertical, counterclockwise seen from above, by ``yaw`` in [rad].
    """
    if (x, y, z, yaw) == (0.0, 0.0, 0.0, 0.0):
        return source

    def moved(px: float, py: float, pz: float) -> tuple[float, float, float]:
        c, s = math.cos(yaw), math.sin(yaw)
        return x + c * px - s * py, y + s * px + c * py, z + pz

    if isinstance(source, ForestFile):
        trees = []
        for each in source.trees:
            px, py, pz = moved(each.x, each.y, each.z)
            trees.append(replace(each, x=px, y=py, z=pz, yaw=each.yaw + yaw))
        anemometer = None if source.anemometer is None else moved(*source.anemometer)
        return replace(source.with_trees(trees), anemometer=anemometer)
    root = moved(*source.tree.start[0].tolist())
    return replace(source, tree=PlacedTree(source.tree.name, source.tree, *root, yaw).placed())
