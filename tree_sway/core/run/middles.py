# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Middles of the segments of a tree at key rotations, each times the square root of its mass."""

from __future__ import annotations

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.run.bank import Bank


class Middles:
    """
    Places the middles of segments.

    Parameters
    ----------
    bank
        Places the tree.
    mass, length
        Mass [kg] and length [m] of each segment, (n,).

    """

    def __init__(self, bank: Bank, mass: Floats, length: Floats) -> None:
        self._bank = bank
        self._root_mass = np.sqrt(mass)
        self._half_length = 0.5 * length
        self.tangent = np.zeros(3 * len(mass))
        """Directions of the segments at the first pose of the last `fill`, (3 n,)."""

    def at(self, rotations: Floats) -> Floats:
        """Return the middles at key rotations (N,), one after another, (3 n,)."""
        out = np.zeros((1, 3 * len(self._root_mass)))
        self.fill(np.ascontiguousarray(rotations)[None], out, 1)
        return out[0]

    def fill(self, rotations: Floats, out: Floats, count: int) -> None:
        """
        Write the middles at the first of some key rotations.

        Key rotations are (k, N), the middles to write (k, 3 n); ``count`` is how many poses are
        asked for.
        """
        self._bank.stand.middles(
            rotations, count, self._root_mass, self._half_length, out, self.tangent
        )
