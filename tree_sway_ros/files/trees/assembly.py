# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The last step of every importer: segments to a `Tree`, with errors that name the file."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from tree_sway_ros.core.arrays import Floats
from tree_sway_ros.core.tree.building import tree_from_segments
from tree_sway_ros.core.tree.parents_first import parents_first
from tree_sway_ros.core.tree.tree import Tree
from tree_sway_ros.errors import FormatError, TreeError

MAX_COORDINATE = 1e8
"""No map has coordinates beyond this [m]; a file with wrong columns soon does."""


def nearest_axis(start: Floats, end: Floats, point: Floats) -> tuple[int, float]:
    """Return which of some axes from start to end (n, 3) is nearest to a point, how far in [m]."""
    axis = end - start
    squared = np.maximum(np.einsum('ij,ij->i', axis, axis), 1e-24)
    along = np.clip(np.einsum('ij,ij->i', point - start, axis) / squared, 0.0, 1.0)
    distance = np.linalg.norm(start + along[:, None] * axis - point, axis=1)
    best = int(np.argmin(distance))
    return best, float(distance[best])


def checked_order(parent: ArrayLike, labels: Sequence[str]) -> list[int]:
    """
    Order in which parents come before what they carry.

    A `TreeError` tells of a parent that does not exist, or a cycle.
    """
    above, n = np.asarray(parent, dtype=np.int64), len(labels)
    for index in np.flatnonzero((above < -1) | (above >= n))[:1]:
        raise TreeError(
            'orphan: its parent does not exist', where=labels[index], cure='name one that does'
        )
    order = parents_first(above.tolist())
    if len(order) < n:
        lost = int(np.setdiff1d(np.arange(n), order)[0])
        raise TreeError(
            'cyclic: following its parents never reaches a root',
            where=labels[lost],
            cure='break the cycle; one without a parent carries all others',
        )
    return order


@dataclass(slots=True)
class SegmentTable:
    """
    Segments as a file lists them; filled row by row, then built.

    Nodes (root-side, tip-side) and diameters (at both) are in [m]. Empty parents (-1 for the root)
    are found from the nodes, empty branch keys from how the segments go on; empty names are
    ``stem``, ``b1`` ... Labels are what an error calls each segment, with the line of the file.
    """

    start: list[list[float]] = field(default_factory=list)
    end: list[list[float]] = field(default_factory=list)
    diameter: list[list[float]] = field(default_factory=list)
    parent: list[int] = field(default_factory=list)
    branch: list[int] = field(default_factory=list)
    branch_names: list[str] = field(default_factory=list)
    labels: list[str] = field(default_factory=list)

    def build(self, source: str, name: str, species: str = 'broadleaf') -> Tree:
        """
        Build the tree.

        Raises
        ------
        TreeError
            What `tree_from_segments` refuses, or coordinates beyond `MAX_COORDINATE`; with the
            file.
        FormatError
            If there is no segment.

        """
        if not self.start:
            raise FormatError('no segments', where=source, cure='give at least one segment')
        extreme = np.abs(np.hstack([self.start, self.end, self.diameter])).max(axis=1)
        for index in np.flatnonzero(extreme > MAX_COORDINATE)[:1]:
            raise TreeError(
                f'a coordinate of {extreme[index]:.3g} m',
                where=self.labels[index],
                cure='give metres; check that the columns are what they should be',
            )
        try:
            return tree_from_segments(
                self.start,
                self.end,
                self.diameter,
                parent=np.array(self.parent, dtype=np.int64) if self.parent else None,
                branch=np.array(self.branch, dtype=np.int64) if self.branch else None,
                branch_names=self.branch_names or None,
                name=name,
                species=species,
                labels=self.labels,
            )
        except TreeError as error:
            raise error.at(error.where or source) from error
