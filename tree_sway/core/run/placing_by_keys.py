# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Placing of one tree by given key rotations, compiled or in numpy."""

from __future__ import annotations

from typing import Protocol

import numpy as np

from tree_sway.core.arrays import Floats, Records
from tree_sway.core.kernel import WHY_PLAIN
from tree_sway.core.run.placing import GIVEN, place, room_for


class PlacingByKeys(Protocol):
    """Places every segment of a tree by its key rotations."""

    def place(
        self,
        rotations: Floats,
        origin: Floats,
        out: Floats,
        cosine: float = 1.0,
        sine: float = 0.0,
        scale: float = 1.0,
    ) -> None:
        """
        Place every segment.

        Parameters
        ----------
        rotations
            Key rotations in [rad], (N,).
        origin
            Root node in [m], (3,).
        out
            Pose block to write, (n, 7).
        cosine, sine
            Cosine and sine of half the rotation of the tree about the vertical.
        scale
            Size of the tree over that of its records.

        """


class CompiledPlacing:
    """`placing.place` with its scratch memory."""

    def __init__(self, branches: Records, segments: Records, blocks: Records) -> None:
        """Make scratch memory."""
        self._segments = segments
        self._blocks = blocks
        self._bases = np.zeros((len(branches), 8))
        self._x = room_for(int(branches['n_coordinates'].sum()))

    def place(
        self,
        rotations: Floats,
        origin: Floats,
        out: Floats,
        cosine: float = 1.0,
        sine: float = 0.0,
        scale: float = 1.0,
    ) -> None:
        """Place every segment, as `PlacingByKeys`."""
        place(
            *GIVEN, self._segments, self._blocks, self._bases, cosine, sine, scale, self._x,
            rotations, origin, out,
        )  # fmt: skip


def placing_by_keys(branches: Records, segments: Records, blocks: Records) -> PlacingByKeys:
    """Return the placing of a tree by its records: compiled, or in numpy where nothing is."""
    if not WHY_PLAIN:
        return CompiledPlacing(branches, segments, blocks)
    from tree_sway.core.run.numpy_placing import NumpyPlacing

    return NumpyPlacing(branches, segments)
