# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""How hot functions are compiled: numpy's division, one precision, the plain function kept."""

from __future__ import annotations

import numpy as np
import pytest

from tree_sway.core.kernel import fused, kernel, like


@kernel
def ratio(a, b):
    return a / b


@fused
def series(x):
    return like(1.0, x) + like(0.5, x) * x


@pytest.mark.compiled
@pytest.mark.parametrize('compiled', [ratio, fused(ratio.py_func)])
def test_division_by_zero_is_infinite_as_in_numpy(compiled):
    assert compiled(1.0, 0.0) == np.inf
    assert np.isnan(compiled(0.0, 0.0))


def test_plain_functions_stay_reachable():
    with pytest.raises(ZeroDivisionError):
        ratio.py_func(1.0, 0.0)
    assert ratio(6.0, 3.0) == ratio.py_func(6.0, 3.0) == 2.0


@pytest.mark.compiled
def test_constants_take_the_precision_of_the_model():
    out = np.zeros(1, dtype=np.float32)

    @kernel
    def fill(x, out):
        out[0] = series(x)
        return like(0.1, x) == np.float32(0.1)

    assert fill(np.float32(0.25), out)
    assert not fill(np.float64(0.25), out)
    assert out[0] == np.float32(1.125)
    assert series(0.25) == series.py_func(0.25) == 1.125
