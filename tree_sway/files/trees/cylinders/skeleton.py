# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Segments from nodes with a radius and a parent, as in skeleton formats."""

from __future__ import annotations

import numpy as np

from tree_sway.core.arrays import Floats, Ints
from tree_sway.errors import FormatError
from tree_sway.files.trees.cylinders.cylinders import Cylinders


def cylinders_of_nodes(
    rows: Ints, point: Floats, diameter: Floats, parent: Ints, labels: list[str], *, cones: bool
) -> Cylinders:
    """
    Make the segments of a tree with one root: one from its parent to each node but the root.

    Several segments may begin at the root node: the thickest is the stem, the others are its
    children.

    Parameters
    ----------
    rows
        Nodes of the tree among all of the file, the root first.
    point, diameter
        Positions (n, 3) and diameters (n,) of the nodes in [m].
    parent
        Parent of each node, (n,), -1 for the root.
    labels
        Names of the nodes in errors.
    cones
        True for segments with the diameters of both nodes, False for that of the outer one.

    Raises
    ------
    FormatError
        A root without other nodes.

    """
    outer = rows[parent[rows] >= 0]
    inner = parent[outer]
    number = np.full(len(parent), -1, dtype=np.int64)
    number[outer] = np.arange(len(outer))
    tip = diameter[outer]
    base = diameter[inner] if cones else tip
    above = number[inner]
    roots = np.flatnonzero(above < 0)
    if len(roots) == 0:
        raise FormatError(
            'a root without other nodes',
            where=labels[rows[0]],
            cure='let at least one node hang on the root',
        )
    stem = roots[np.argmax(tip[roots])]
    above[roots[roots != stem]] = stem
    return Cylinders(
        point[inner], point[outer], np.column_stack([base, tip]), above, None,
        [labels[index] for index in outer],
    )  # fmt: skip
