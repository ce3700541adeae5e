"""The number that counts."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest

from tree_sway_ros.core.integrators.minimal import semi_implicit_euler
from tree_sway_ros.core.integrators.operation_count import CountedNumber, counted, flops, plain


def test_every_operation_is_counted_once_and_right():
    tally: Counter[str] = Counter()
    x = CountedNumber(2.0, tally)
    y = np.cos((3 * x - 1) / x + 0.5) - np.sqrt(x) * np.sin(x)
    assert float(y) == pytest.approx(np.cos(3.0) - np.sqrt(2) * np.sin(2.0))
    assert tally == {"multiply": 2, "add": 3, "divide": 1, "transcendental": 2, "sqrt": 1}
    assert flops(tally) == 2 + 3 + 4 + 40 + 4


def test_comparisons_and_signs_are_free():
    tally: Counter[str] = Counter()
    x = CountedNumber(-2.0, tally)
    assert x < 1 and abs(x) > 1 and -x == 2 and x <= -2 and not x >= 0  # noqa: PT018
    assert not tally


def test_a_kernel_runs_on_counted_numbers_as_on_floats():
    table = np.array([[1.0, 0.1, 0.5, 1.0, 50.0, 0.4]])
    state, load = np.array([[0.1], [0.2], [0.0], [0.0]]), np.array([[[1.0, 3.0]]])
    tally: Counter[str] = Counter()
    twin = counted(state, tally)
    plain(semi_implicit_euler.step)(counted(table, tally), twin, counted(load, tally), 0.01, None)
    semi_implicit_euler.step(table, state, load, 0.01, np.zeros(1))
    assert twin.astype(float) == pytest.approx(state, rel=1e-15)
    assert tally["transcendental"] == 2
