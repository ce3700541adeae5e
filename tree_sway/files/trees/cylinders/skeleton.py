# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Nodes with a radius and a parent, as skeleton formats have them, made into segments."""

from __future__ import annotations

import numpy as np

from tree_sway.core.arrays import Floats, Ints
from tree_sway.errors import FormatError
from tree_sway.files.trees.cylinders.cylinders import Cylinders


def cylinders_of_nodes(
    point: Floats, diameter: Floats, parent: Ints, labels: list[str], source: str, *, cones: bool
) -> Cylinders:
    """
    Segments of a tree with one root: one from its parent to each node but the root.

    Several segments may begin at the root node: the thickest is the stem, the others sit on it.

    Parameters
    ----------
    point, diameter
        Positions (n, 3) and diameters (n,) of the nodes in [m].
    parent
        Node that each one follows, (n,), -1 for the root.
    labels, source
        How an error calls each node, and the file.
    cones
        Whether a segment has the diameters of its two nodes; that of the outer one if not.

    Raises
    ------
    FormatError
        Nothing but a root.

    """
    outer = np.flatnonzero(parent >= 0)
    if len(outer) == 0:
        what = 'a root with nothing on it'
        raise FormatError(what, where=source, cure='give at least two nodes')
    inner = parent[outer]
    number = np.full(len(parent), -1, dtype=np.int64)
    number[outer] = np.arange(len(outer))
    base, above = diameter[inner] if cones else diameter[outer], number[inner]
    roots = np.flatnonzero(above < 0)
    stem = roots[np.argmax(diameter[outer][roots])]
    above[roots[roots != stem]] = stem
    return Cylinders(
        point[inner],
        point[outer],
        np.stack([base, diameter[outer]], axis=1),
        above,
        None,
        [labels[index] for index in outer],
    )
