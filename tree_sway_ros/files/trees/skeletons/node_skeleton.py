"""Nodes with a radius and a parent, as skeleton formats have them, to the segments between them."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from tree_sway_ros.core.arrays import Floats, Ints
from tree_sway_ros.errors import FormatError
from tree_sway_ros.files.trees.cylinders.cylinders import Cylinders


@dataclass(slots=True)
class Skeleton:
    """
    Nodes of one or several trees.

    Parameters
    ----------
    point
        Position of each node in [m].
    diameter
        Diameter at each node in [m].
    parent
        Position of each one's parent in these lists, -1 at a root.
    labels
        What an error calls each.

    """

    point: list[list[float]] = field(default_factory=list)
    diameter: list[float] = field(default_factory=list)
    parent: list[int] = field(default_factory=list)
    labels: list[str] = field(default_factory=list)

    def cylinders(self, source: str, *, cones: bool) -> Cylinders:
        """
        Segments of a tree with one root: one from its parent to each node but the root.

        Parameters
        ----------
        source
            The file.
        cones
            Whether a segment has the diameters of its two nodes, or that of its outer node only.

        Raises
        ------
        FormatError
            If there is nothing but a root.

        """
        parent = np.array(self.parent, dtype=np.int64)
        outer = np.flatnonzero(parent >= 0)
        if len(outer) == 0:
            raise FormatError(
                "a root with nothing on it", where=source, cure="give at least two nodes"
            )
        point, width = np.array(self.point), np.array(self.diameter)
        inner = parent[outer]
        number = np.full(len(parent), -1, dtype=np.int64)
        number[outer] = np.arange(len(outer))
        base = width[inner] if cones else width[outer]
        return Cylinders(
            point[inner],
            point[outer],
            np.stack([base, width[outer]], axis=1),
            _one_root(number[inner], width[outer]),
            None,
            [self.labels[index] for index in outer],
        )


def _one_root(parent: Ints, width: Floats) -> Ints:
    """
    Several segments may begin at the root node: the thickest is the stem, the others sit on it.

    """
    roots = np.flatnonzero(parent < 0)
    if len(roots) > 1:
        stem = roots[np.argmax(width[roots])]
        parent[roots[roots != stem]] = stem
    return parent
