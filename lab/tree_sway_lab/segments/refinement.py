# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A tree with every segment cut in equal pieces: the same wood, more joints or elements."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tree_sway.core.tree import Tree


def refined(tree: Tree, pieces: int) -> Tree:
    """
    Cut every segment of a tree in this many equal pieces.

    Piece j of segment i becomes segment ``pieces * i + j``. A branch remains at the same
    point.
    """
    if pieces == 1:
        return tree
    low = np.tile(np.arange(pieces) / pieces, tree.n_segments)[:, None]
    high = low + 1.0 / pieces
    start, chord = np.repeat(tree.start, pieces, 0), np.repeat(tree.end - tree.start, pieces, 0)
    width = np.repeat(tree.base_diameter, pieces)
    taper = np.repeat(tree.tip_diameter - tree.base_diameter, pieces)
    parent = np.arange(-1, pieces * tree.n_segments - 1, dtype=np.int64)
    piece = np.minimum((tree.place_on_parent * pieces + 1e-9).astype(np.int64), pieces - 1)
    parent[::pieces] = np.where(tree.segment_parent < 0, -1, pieces * tree.segment_parent + piece)
    return replace(
        tree,
        start=start + low * chord,
        end=start + high * chord,
        base_diameter=width + low[:, 0] * taper,
        tip_diameter=width + high[:, 0] * taper,
        segment_parent=parent,
        branch_first=pieces * tree.branch_first,
        source_index=np.repeat(tree.source_index, pieces),
    )
