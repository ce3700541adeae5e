"""
The tree as JSON: what the poses do not say, once, for whoever draws them.

Row i of every list belongs to pose i of `segment_poses`. The version is raised when a reader of the old form
would go wrong; new keys alone do not raise it.

"""

from __future__ import annotations

import json
from typing import Any

import numpy as np

from tree_sway_ros.core.leaf_flutter import leaf_list
from tree_sway_ros.core.leaves import leaf_clusters as leaf_clusters_of
from tree_sway_ros.core.tree import Tree

VERSION = 1
REPEAT_PERIOD = 5.0
"""From one description to the next [s]: bags and bridges lose a latched topic."""

_LENGTHS = {"type": "array", "items": {"type": "number", "exclusiveMinimum": 0}}
_NAMES = {"type": "array", "items": {"type": "string"}}
_INDICES = {"type": "array", "items": {"type": "integer", "minimum": -1}}
SCHEMA: dict[str, Any] = {
    "$schema": "https://json-schema.org/draft/2020-12/schema",
    "title": "tree_sway_ros tree_description",
    "type": "object",
    "required": ["version", "name", "species", "frame_id", "segments", "branches"],
    "properties": {
        "version": {"const": VERSION},
        "name": {"type": "string"},
        "species": {"type": "string"},
        "frame_id": {"type": "string"},
        "segments": {
            "type": "object",
            "description": "one item a segment; SI units",
            "required": ["names", "parents", "lengths", "base_radii", "tip_radii", "branches"],
            "properties": {
                "names": _NAMES,
                "parents": _INDICES,
                "lengths": _LENGTHS,
                "base_radii": _LENGTHS,
                "tip_radii": _LENGTHS,
                "branches": _INDICES,
            },
        },
        "branches": {
            "type": "object",
            "description": "one item a branch, depth first",
            "required": ["names", "parents", "first_segments"],
            "properties": {"names": _NAMES, "parents": _INDICES, "first_segments": _INDICES},
        },
        "leaves": {
            "type": "object",
            "description": "one item a leaf cluster, carried by its segment; absent without leaves",
            "required": ["segment", "flutter"],
        },
    },
}


def describe(tree: Tree, frame_id: str, leaf_clusters: int = 0) -> str:
    """
    Describe a tree as JSON of `SCHEMA`.

    Parameters
    ----------
    tree
        The tree.
    frame_id
        Frame of the poses.
    leaf_clusters
        How many clusters of leaves to place on it, always the same ones; none if 0.

    """
    leaves = {}
    if leaf_clusters > 0:
        clusters = leaf_clusters_of(tree, np.random.default_rng(0), count=leaf_clusters)
        leaves = {"leaves": leaf_list(clusters)}
    return json.dumps(
        {
            **leaves,
            "version": VERSION,
            "name": tree.name,
            "species": tree.species,
            "frame_id": frame_id,
            "segments": {
                "names": list(tree.segment_names),
                "parents": tree.segment_parent.tolist(),
                "lengths": tree.length.tolist(),
                "base_radii": (tree.base_diameter / 2.0).tolist(),
                "tip_radii": (tree.tip_diameter / 2.0).tolist(),
                "branches": tree.branch_of_segment.tolist(),
            },
            "branches": {
                "names": list(tree.branch_names),
                "parents": tree.branch_parent.tolist(),
                "first_segments": tree.branch_first[:-1].tolist(),
            },
        },
        separators=(",", ":"),
    )
