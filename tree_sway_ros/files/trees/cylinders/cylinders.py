# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Cylinders or cones of a scanned or digitised tree, as the reader of a format gives them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tree_sway_ros.core.arrays import Floats, Ints
from tree_sway_ros.files.table_file import TextTable


@dataclass(slots=True)
class Cylinders:
    """
    Cylinders or cones of one tree, in the order of the file.

    Parameters
    ----------
    start, end
        Root-side and tip-side end of the axis in [m], (n, 3).
    diameter
        Diameter at start and at end in [m], (n, 2).
    parent
        Cylinder that each sits on, -1 at the root, (n,).
    continues
        Whether each goes on with its parent's branch, (n,); None if the file does not say.
    labels
        What an error calls each one.
    name
        Name of the tree, if the file has one.
    notes
        What the reader of the format has to say.

    """

    start: Floats
    end: Floats
    diameter: Floats
    parent: Ints
    continues: NDArray[np.bool_] | None
    labels: list[str]
    name: str = ""
    notes: tuple[str, ...] = ()


def cylinder_axes(table: TextTable, radius: str) -> tuple[Floats, Floats, Floats]:
    """Starts, ends (n, 3) and diameters (n, 2) of a table with both ends and a radius."""
    values = table.strict(["startX", "startY", "startZ", "endX", "endY", "endZ", radius, radius])
    return values[:, :3], values[:, 3:6], 2.0 * values[:, 6:]
