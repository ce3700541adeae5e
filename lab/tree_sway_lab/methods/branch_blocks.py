# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Many two-axis branches in blocks of sixteen, so that one instruction steps several of them.

Everything a branch needs is in one array: block, row, slot. Rows are x, y, vx, vy; wb, w1, w2;
the eight coefficients; the three guards. Distances between the rows of a slot are then constants
that the compiler knows, which lets it turn the loop over slots into vector instructions.

"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

from tree_sway_lab.kernel import fused
from tree_sway_lab.methods.branch_bank import single_precision
from tree_sway_lab.methods.two_axis import step_branch

WIDTH = 16
ROWS = 18
_LOAD, _COEFFICIENT = slice(4, 7), slice(7, 15)

Array = NDArray[Any]


class BranchBlocks:
    """
    A bank of branches, at rest and without load at first.

    Parameters
    ----------
    coefficients
        Rows of `oscillators.propagator`, (n, 8).
    guard
        Rows of `branch_bank.guards`, (n, 3).
    dtype
        float32 for speed, float64 for digits.

    """

    def __init__(self, coefficients: Array, guard: Array, dtype: DTypeLike = np.float32) -> None:
        self._n = len(coefficients)
        blocks = -(-self._n // WIDTH)
        rows = single_precision(coefficients) if dtype == np.float32 else coefficients
        self._data = np.zeros((blocks, ROWS, WIDTH), dtype)
        self._put(_COEFFICIENT, rows.T)
        self._put(slice(15, 18), guard.T)
        self._limit = np.square(guard[:, 1])
        self._held = 0

    @property
    def state(self) -> Array:
        """x, y [rad], vx, vy [rad/s] of each branch, a copy, (4, n)."""
        return self._get(slice(0, 4))

    @state.setter
    def state(self, value: ArrayLike) -> None:
        """Set all four rows."""
        self._put(slice(0, 4), np.asarray(value))

    @property
    def load(self) -> Array:
        """Force times lever along b, e1, e2 in [N m], a copy, (3, n)."""
        return self._get(_LOAD)

    @load.setter
    def load(self, value: ArrayLike) -> None:
        """Set all three rows, and count those beyond their limit."""
        load = np.asarray(value)
        self._put(_LOAD, load)
        square = np.square(load.astype(float)).sum(0)
        self._held = int(np.count_nonzero(~(square <= self._limit)))

    def step(self) -> int:
        """Step every branch under its load; return how many loads were clamped."""
        _step(self._data.ravel(), len(self._data))
        return self._held

    def _put(self, rows: slice, values: Array) -> None:
        padded = np.zeros((len(values), len(self._data) * WIDTH), self._data.dtype)
        padded[:, : self._n] = values
        self._data[:, rows] = padded.reshape(len(values), -1, WIDTH).swapaxes(0, 1)

    def _get(self, rows: slice) -> Array:
        return (
            self._data[:, rows]
            .swapaxes(0, 1)
            .reshape(rows.stop - rows.start, -1)[:, : self._n]
            .copy()
        )


@fused
def _step(d: Array, blocks: int) -> None:
    """Step the slots of each block; d is the flat array."""
    for block in range(blocks):
        first = block * ROWS * WIDTH
        for slot in range(WIDTH):
            k = first + slot
            x, y, vx, vy, _ = step_branch(
                d[k], d[k + WIDTH], d[k + 2 * WIDTH], d[k + 3 * WIDTH],
                d[k + 4 * WIDTH], d[k + 5 * WIDTH], d[k + 6 * WIDTH],
                d[k + 7 * WIDTH], d[k + 8 * WIDTH], d[k + 9 * WIDTH], d[k + 10 * WIDTH],
                d[k + 11 * WIDTH], d[k + 12 * WIDTH], d[k + 13 * WIDTH], d[k + 14 * WIDTH],
                d[k + 15 * WIDTH], d[k + 16 * WIDTH], d[k + 17 * WIDTH],
            )  # fmt: skip
            d[k], d[k + WIDTH], d[k + 2 * WIDTH], d[k + 3 * WIDTH] = x, y, vx, vy
