# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The number that counts."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest
from tree_sway_lab.methods.dense import solve
from tree_sway_lab.methods.minimal import semi_implicit_euler
from tree_sway_lab.methods.operation_count import counted, CountedNumber, flops, plain


def test_every_operation_is_counted_once_and_right():
    tally: Counter[str] = Counter()
    x = CountedNumber(2.0, tally)
    y = np.cos((3 * x - 1) / x + 0.5) - np.sqrt(x) * np.sin(x)
    assert float(y) == pytest.approx(np.cos(3.0) - np.sqrt(2) * np.sin(2.0))
    assert tally == {'multiply': 2, 'add': 3, 'divide': 1, 'transcendental': 2, 'sqrt': 1}
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
    assert tally['transcendental'] == 2


@pytest.mark.parametrize(('m', 'k'), [(1, 1), (4, 1), (7, 3)])
def test_elimination_costs_what_the_textbook_says(m, k):
    """Products m (m - 1) (2 m - 1) / 6 + k m (m - 1), divisions m (m - 1) / 2 + k m."""
    rng, tally = np.random.default_rng(m), Counter()
    a = counted(rng.normal(size=(m, m)) + m * np.eye(m), tally)
    assert plain(solve)(a, counted(rng.normal(size=(m, k)), tally))
    products = m * (m - 1) * (2 * m - 1) // 6 + k * m * (m - 1)
    assert tally['multiply'] == tally['add'] == products
    assert tally['divide'] == m * (m - 1) // 2 + k * m


def test_reflected_operations_and_conversion():
    tally: Counter[str] = Counter()
    x = CountedNumber(4.0, tally)
    assert float(10 - x) == 6.0
    assert float(2 / x) == 0.5
    assert float(x / 8 + 1) == 1.5
    assert tally == {'add': 2, 'divide': 2}
    with pytest.raises(TypeError):
        hash(x)
    assert np.array_equal(counted([[1.0, 2.0]], tally).astype(float), [[1.0, 2.0]])


def test_a_plain_kernel_is_plain_all_the_way_down():
    twin = plain(semi_implicit_euler.step)
    inner = twin.__globals__['acceleration']
    assert not hasattr(inner, 'py_func')
    assert not hasattr(inner.__globals__['solve'], 'py_func')
    assert hasattr(semi_implicit_euler.acceleration, 'py_func'), 'the compiled one is left alone'
