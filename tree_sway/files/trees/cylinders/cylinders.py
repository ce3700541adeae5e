# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Cylinders or cones of a scanned or digitised tree, as returned by the reader of a format."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.arrays import Floats, Ints
from tree_sway.files.table_file import TextTable


@dataclass(slots=True)
class Cylinders:
    """
    Cylinders or cones of one tree, in the order of the file.

    Root-side and tip-side ends (n, 3) and diameters at both (n, 2) are in [m]; the parent is -1 at
    the root; ``continues`` marks those that continue their parent's branch, None if the file does
    not have it. Labels are names in errors, notes those of the reader of the format.
    """

    start: Floats
    end: Floats
    diameter: Floats
    parent: Ints
    continues: NDArray[np.bool_] | None
    labels: list[str]
    name: str = ''
    notes: tuple[str, ...] = ()


def cylinder_axes(table: TextTable, radius: str) -> tuple[Floats, Floats, Floats]:
    """Return starts, ends (n, 3) and diameters (n, 2) of a table with both ends and a radius."""
    values = table.strict(['startX', 'startY', 'startZ', 'endX', 'endY', 'endZ', radius, radius])
    return values[:, :3], values[:, 3:6], 2.0 * values[:, 6:]
