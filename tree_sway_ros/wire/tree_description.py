# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Description of the tree as JSON: the data beside its poses, for drawing.

Row i of every list belongs to pose i of `segment_poses`. The version is raised when the old form
cannot be read as before; new keys do not raise it.
"""

from __future__ import annotations

import json

import numpy as np

from tree_sway.core.leaves import FLUTTER, LeafClusters
from tree_sway.core.tree import Tree
from tree_sway.core.tree_state import digest_of

VERSION = 1

_LAW = 'largest_angle tanh(gain U^2 / (frequency largest_angle)) sin(2 pi frequency t + phase)'
"""Law of the angle at which leaves flutter, for who reads it."""


def describe(
    tree: Tree, frame_id: str, tree_frame: str = 'tree', leaves: LeafClusters | None = None
) -> str:
    """
    Describe a tree as JSON of ``doc/tree_description.schema.json``.

    ``frame_id`` is the frame of its poses, ``tree_frame`` the one at its own origin.

    Of trees joined to one record, each begins with a segment whose parent is -1.
    """
    return json.dumps(
        {
            **({} if leaves is None else {'leaves': _leaf_list(leaves)}),
            'version': VERSION,
            'name': tree.name,
            'hash': digest_of(tree),
            'species': tree.species,
            'frame_id': frame_id,
            'tree_frame': tree_frame,
            'segments': {
                'names': list(tree.segment_names),
                'parents': tree.segment_parent.tolist(),
                'lengths': tree.length.tolist(),
                'base_radii': (tree.base_diameter / 2.0).tolist(),
                'tip_radii': (tree.tip_diameter / 2.0).tolist(),
                'branches': tree.branch_of_segment.tolist(),
            },
            'branches': {
                'names': list(tree.branch_names),
                'parents': tree.branch_parent.tolist(),
                'first_segments': tree.branch_first[:-1].tolist(),
            },
        },
        separators=(',', ':'),
    )


def _leaf_list(clusters: LeafClusters) -> dict[str, object]:
    """
    Describe the leaves as plain numbers and lists, all that a viewer needs to draw them.

    A list per field of `LeafClusters`, rounded to 0.1 mm and 1e-4, and ``flutter`` with the law
    and its two constants.
    """
    listed = {name: np.round(values, 4).tolist() for name, values in vars(clusters).items()}
    return {**listed, 'flutter': {'law': _LAW, **FLUTTER}}
