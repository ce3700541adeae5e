# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Nodes with a radius and a parent, as skeleton formats have them, made into segments."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tree_sway.core.arrays import Floats, Ints
from tree_sway.errors import FormatError
from tree_sway.files.trees.cylinders.cylinders import Cylinders


@dataclass(frozen=True)
class Skeleton:
    """Nodes of a tree: positions (n, 3) and diameters (n,) in [m], parents (n,), the root's -1."""

    point: Floats
    diameter: Floats
    parent: Ints
    labels: list[str]

    def cylinders(self, source: str, *, cones: bool) -> Cylinders:
        """
        Segments of a tree with one root: one from its parent to each node but the root.

        Several segments may begin at the root node: the thickest is the stem, the others sit on
        it. Cones have the diameters of their two nodes, others that of the outer one. A
        `FormatError` is raised for nothing but a root.
        """
        outer = np.flatnonzero(self.parent >= 0)
        if len(outer) == 0:
            raise FormatError(
                'a root with nothing on it', where=source, cure='give at least two nodes'
            )
        inner, width = self.parent[outer], self.diameter
        number = np.full(len(self.parent), -1, dtype=np.int64)
        number[outer] = np.arange(len(outer))
        parent, base = number[inner], width[inner] if cones else width[outer]
        roots = np.flatnonzero(parent < 0)
        stem = roots[np.argmax(width[outer][roots])]
        parent[roots[roots != stem]] = stem
        return Cylinders(
            self.point[inner],
            self.point[outer],
            np.stack([base, width[outer]], axis=1),
            parent,
            None,
            [self.labels[index] for index in outer],
        )
