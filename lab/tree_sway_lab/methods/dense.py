# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Small dense linear algebra for the integrators: plain loops, so that any number type can run them.

Floats compile to machine code; numbers that count their operations, or carry more digits, run the
same lines uncompiled.

"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tree_sway_lab.kernel import kernel

Array = NDArray[Any]


@kernel
def solve(a: Array, b: Array) -> bool:
    """
    Solve a x = b in place by elimination with partial pivoting; zeros cost nothing.

    Parameters
    ----------
    a
        Matrix (m, m), destroyed.
    b
        Right-hand sides (m, k), overwritten by the solution.

    Returns
    -------
    bool
        False where the matrix is singular or not finite.

    """
    m, k = b.shape
    for col in range(m):
        best = col
        for row in range(col + 1, m):
            if abs(a[row, col]) > abs(a[best, col]):
                best = row
        if not abs(a[best, col]) > 0.0:
            return False
        if best != col:
            for j in range(col, m):
                a[col, j], a[best, j] = a[best, j], a[col, j]
            for j in range(k):
                b[col, j], b[best, j] = b[best, j], b[col, j]
        for row in range(col + 1, m):
            if a[row, col] == 0.0:
                continue
            factor = a[row, col] / a[col, col]
            for j in range(col + 1, m):
                if a[col, j] != 0.0:
                    a[row, j] = a[row, j] - factor * a[col, j]
            for j in range(k):
                b[row, j] = b[row, j] - factor * b[col, j]
    for col in range(m - 1, -1, -1):
        for j in range(k):
            b[col, j] = b[col, j] / a[col, col]
            for row in range(col):
                if a[row, col] != 0.0:
                    b[row, j] = b[row, j] - a[row, col] * b[col, j]
    return True


@kernel
def multiply(a: Array, b: Array) -> Array:
    """Matrix product (m, m) (m, k); zeros cost nothing."""
    m, k = b.shape
    out = np.empty((m, k), b.dtype)
    for i in range(m):
        for j in range(k):
            total = a[i, 0] * b[0, j]
            for n in range(1, m):
                if a[i, n] != 0.0 and b[n, j] != 0.0:
                    total = total + a[i, n] * b[n, j]
            out[i, j] = total
    return out


@kernel
def exponential(a: Array) -> Array:
    """Exponential of a matrix by scaling, Taylor series and squaring (Higham 2008, 10.3)."""
    m = len(a)
    norm = 0.0 * abs(a[0, 0])
    for i in range(m):
        total = abs(a[i, 0])
        for j in range(1, m):
            total = total + abs(a[i, j])
        norm = max(norm, total)
    halvings = 0
    while norm > 0.5 and halvings < 60:
        norm = norm * 0.5
        halvings += 1
    scaled = a * 0.5**halvings
    power = scaled.copy()
    out = scaled.copy()
    for n in range(2, 14):
        power = multiply(power, scaled) * (1.0 / n)
        out = out + power
    for _ in range(halvings):  # (1 + x)^2 - 1 keeps small entries exact
        out = multiply(out, out) + out * 2.0
    for i in range(m):
        out[i, i] = out[i, i] + 1.0
    return out
