# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Products of small dense matrices and a solution, for kernels and for numpy.

Each function is numpy where nothing is compiled. Kernels call its loop instead: BLAS would start
threads for such products, and a sum then depends on their number.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.linalg import get_lapack_funcs

from tree_sway.core.arrays import Floats, Ints
from tree_sway.core.kernel import LOOP_OPTIONS, part, WHY_PLAIN

(_solve_by_lapack,) = get_lapack_funcs(('posv',), dtype=np.float64)


def dot(a: Floats, b: Floats) -> float:
    """Return the scalar product of two vectors (n,)."""
    return float(a @ b)


def largest(values: Floats) -> float:
    """Return the largest absolute value of a vector (n,)."""
    return float(np.abs(values).max(initial=0.0))


def copy(values: Floats, out: Floats) -> None:
    """Copy a vector (n,)."""
    out[:] = values


def multiply(matrix: Floats, vector: Floats, out: Floats) -> None:
    """Write the product of a matrix (n, m) and a vector (m,) to (n,)."""
    np.matmul(matrix, vector, out=out)


def multiply_rows(rows: Floats, others: Floats, out: Floats) -> None:
    """Write the scalar product of each row (k, p) and each other row (q, p) to (k, q)."""
    np.matmul(rows, others.T, out=out)


def take_block(matrix: Floats, rows: Ints, out: Floats) -> None:
    """Write the block of some rows (k,) and the columns of these numbers to (k, k)."""
    out[:] = matrix[np.ix_(rows, rows)]


def solve_positive(matrix: Floats, rights: Floats) -> bool:
    """
    Solve for some right-hand sides (k, n), which the solutions replace.

    Returns whether the symmetric matrix (n, n), whose lower half is overwritten, was positive
    definite.
    """
    _, solved, failed = _solve_by_lapack(matrix, rights.T, lower=1)
    if not failed:
        rights[:] = solved.T
    return not failed


@part
def _four_by_two(rows: Floats, i: int, others: Floats, j: int, out: Floats) -> None:
    """Write the products of four rows and two others; each number that is read serves several."""
    one_one = 0.0
    two_one = 0.0
    three_one = 0.0
    four_one = 0.0
    one_two = 0.0
    two_two = 0.0
    three_two = 0.0
    four_two = 0.0
    for k in range(rows.shape[1]):
        other = others[j, k]
        next_other = others[j + 1, k]
        one = rows[i, k]
        two = rows[i + 1, k]
        three = rows[i + 2, k]
        four = rows[i + 3, k]
        one_one += one * other
        two_one += two * other
        three_one += three * other
        four_one += four * other
        one_two += one * next_other
        two_two += two * next_other
        three_two += three * next_other
        four_two += four * next_other
    out[i, j] = one_one
    out[i, j + 1] = one_two
    out[i + 1, j] = two_one
    out[i + 1, j + 1] = two_two
    out[i + 2, j] = three_one
    out[i + 2, j + 1] = three_two
    out[i + 3, j] = four_one
    out[i + 3, j + 1] = four_two


if not WHY_PLAIN:
    from numba.extending import overload

    def _loop_of(function: Any) -> Any:
        return overload(function, jit_options=LOOP_OPTIONS)

    @_loop_of(dot)
    def _dot(a, b):  # type: ignore[no-untyped-def]
        def loop(a, b):  # type: ignore[no-untyped-def]
            total = 0.0
            for i in range(len(a)):
                total += a[i] * b[i]
            return total

        return loop

    @_loop_of(largest)
    def _largest(values):  # type: ignore[no-untyped-def]
        def loop(values):  # type: ignore[no-untyped-def]
            most = 0.0
            for i in range(len(values)):
                most = max(most, abs(values[i]))
            return most

        return loop

    @_loop_of(copy)
    def _copy(values, out):  # type: ignore[no-untyped-def]
        def loop(values, out):  # type: ignore[no-untyped-def]
            for i in range(len(values)):
                out[i] = values[i]

        return loop

    @_loop_of(multiply)
    def _multiply(matrix, vector, out):  # type: ignore[no-untyped-def]
        def loop(matrix, vector, out):  # type: ignore[no-untyped-def]
            for i in range(len(matrix)):
                total = 0.0
                for k in range(len(vector)):
                    total += matrix[i, k] * vector[k]
                out[i] = total

        return loop

    @_loop_of(multiply_rows)
    def _multiply_rows(rows, others, out):  # type: ignore[no-untyped-def]
        def loop(rows, others, out):  # type: ignore[no-untyped-def]
            in_fours = len(rows) - len(rows) % 4
            in_twos = len(others) - len(others) % 2
            for j in range(0, in_twos, 2):
                for i in range(0, in_fours, 4):
                    _four_by_two(rows, i, others, j, out)
            for j in range(len(others)):
                first = in_fours if j < in_twos else 0
                for i in range(first, len(rows)):
                    total = 0.0
                    for k in range(rows.shape[1]):
                        total += rows[i, k] * others[j, k]
                    out[i, j] = total

        return loop

    @_loop_of(take_block)
    def _take_block(matrix, rows, out):  # type: ignore[no-untyped-def]
        def loop(matrix, rows, out):  # type: ignore[no-untyped-def]
            for i in range(len(rows)):
                for k in range(len(rows)):
                    out[i, k] = matrix[rows[i], rows[k]]

        return loop

    @_loop_of(solve_positive)
    def _solve_positive(matrix, rights):  # type: ignore[no-untyped-def]
        def loop(matrix, rights):  # type: ignore[no-untyped-def]
            n = len(matrix)
            # Cholesky's decomposition L L' by rows; the diagonal holds 1 / L_ii.
            for i in range(n):
                for k in range(i):
                    total = matrix[i, k]
                    for p in range(k):
                        total -= matrix[i, p] * matrix[k, p]
                    matrix[i, k] = total * matrix[k, k]
                rest = matrix[i, i]
                for p in range(i):
                    rest -= matrix[i, p] * matrix[i, p]
                if not rest > 0.0:
                    return False
                matrix[i, i] = 1.0 / np.sqrt(rest)
            for right in range(len(rights)):
                for i in range(n):
                    total = rights[right, i]
                    for p in range(i):
                        total -= matrix[i, p] * rights[right, p]
                    rights[right, i] = total * matrix[i, i]
                for i in range(n - 1, -1, -1):
                    solved = rights[right, i] * matrix[i, i]
                    rights[right, i] = solved
                    for p in range(i):
                        rights[right, p] -= matrix[i, p] * solved
            return True

        return loop
