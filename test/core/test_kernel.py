# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""How hot functions are compiled: numpy's division, the plain function kept."""

from __future__ import annotations

import numpy as np
import pytest

from tree_sway.core.kernel import fused, kernel


@kernel
def ratio(a, b):
    return a / b


@pytest.mark.compiled
@pytest.mark.parametrize('compiled', [ratio, fused(ratio.py_func)])
def test_division_by_zero_is_infinite_as_in_numpy(compiled):
    assert compiled(1.0, 0.0) == np.inf
    assert np.isnan(compiled(0.0, 0.0))


def test_plain_functions_stay_reachable():
    with pytest.raises(ZeroDivisionError):
        ratio.py_func(1.0, 0.0)
    assert ratio(6.0, 3.0) == ratio.py_func(6.0, 3.0) == 2.0
