# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Middles of the segments of a tree at key rotations, each times the square root of its mass."""

from __future__ import annotations

from functools import cached_property, partial
from typing import Any

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.kernel import entry_of, fused
from tree_sway.core.run.bank import Bank
from tree_sway.core.tree.segment_frame import ends_of_poses


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
        self._root, self._half = np.sqrt(mass), 0.5 * length
        self._origin, self._poses = np.zeros(3), np.zeros((len(mass), 7))

    def fill(self, rotations: Floats, out: Floats) -> Floats:
        """Write the middles at key rotations (N,) one after another, (3 n,), and return them."""
        self._bank.place(rotations, self._origin, self._poses)
        if self._bank.plain:
            middle = ends_of_poses(self._poses, self._half)[1]
            np.multiply(self._root[:, None], middle, out=out.reshape(-1, 3))
        else:
            self._compiled(out)
        return out

    @cached_property
    def _compiled(self) -> Any:
        arrays = self._poses, self._half, self._root
        return partial(entry_of(_write_middles, *arrays, np.zeros(3)), *arrays)


@fused
def _write_middles(poses: Floats, half: Floats, root: Floats, out: Floats) -> None:
    for i in range(len(half)):
        x, y, z, w = poses[i, 3], poses[i, 4], poses[i, 5], poses[i, 6]
        c, s = root[i], 2.0 * half[i]
        out[3 * i] = c * (poses[i, 0] + half[i] - s * (y * y + z * z))
        out[3 * i + 1] = c * (poses[i, 1] + s * (x * y + w * z))
        out[3 * i + 2] = c * (poses[i, 2] + s * (x * z - w * y))
