# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Test that slots come to their rows and back."""

import numpy as np
import pytest

from tree_sway.core.kernel import fused
from tree_sway.core.run.past_caches import settle, write_past_caches
from tree_sway.core.run.simd import add_shapes, put_four, shapes_together, take_four


@fused
def _there(slots, row, slot, rows, which, first):
    put_four(slots, row, slot, rows, which[0], which[1], which[2], which[3], first)


@fused
def _back(rows, which, first, slots, row, slot):
    take_four(rows, which[0], which[1], which[2], which[3], first, slots, row, slot)


def test_four_slots_go_to_four_rows_and_back_compiled_and_plain() -> None:
    slots = np.arange(7 * 16.0).reshape(7, 16)
    which = np.array([5, 0, 3, 8])
    for there, back in ((_there, _back), (_there.py_func, _back.py_func)):
        rows, found = np.full((9, 7), -1.0), np.full((7, 16), -1.0)
        there(slots, 2, 9, rows, which, 1)
        assert (rows[which, 1:5] == slots[2:6, 9:13].T).all()
        assert (rows == -1.0).sum() == rows.size - 16
        back(rows, which, 1, found, 3, 4)
        assert (found[3:7, 4:8] == slots[2:6, 9:13]).all()
        assert (found == -1.0).sum() == found.size - 16


@fused
def _sum(shapes, amounts, into):
    for block in range(len(shapes)):
        add_shapes(shapes, block, amounts, into)


@pytest.mark.parametrize('n', [1, 64, 150])
def test_shapes_are_summed_as_by_numpy_compiled_and_plain(n: int) -> None:
    rng = np.random.default_rng(n)
    exact, amounts = rng.normal(0.0, 1.0, (36, n)), rng.normal(0.0, 1.0, 36).astype(np.float32)
    shapes = exact.astype(np.float32).astype(np.float64)
    laid = shapes_together(shapes)
    for function in (_sum, _sum.py_func):
        found = np.full(len(laid) * 64, np.nan)
        function(laid, amounts, found)
        np.testing.assert_allclose(found[:n], amounts @ shapes, atol=1e-5)
        assert (found[n:] == 0.0).all()


@fused
def _write(of, into):
    write_past_caches(of, into)
    settle()


def test_what_is_written_past_the_caches_is_all_there_wherever_it_begins() -> None:
    of = np.arange(1.0, 42.0)
    memory = np.zeros(8 * 80 + 4, dtype=np.uint8)
    for offset in (0, 4):
        whole = memory[offset : offset + 8 * 80].view(np.float64)
        for first in range(9):
            for n in (0, 1, 7, 8, 9, 40, 41):
                whole[:] = -1.0
                _write(of[:n], whole[first : first + n])
                assert (whole[first : first + n] == of[:n]).all()
                assert (whole == -1.0).sum() == 80 - n
