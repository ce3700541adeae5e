# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Cylinders or cones of a scanned or digitised tree, as returned by the reader of a format."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.arrays import Floats, Ints


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


Trees = tuple[Cylinders, ...]
"""The trees of a file."""
