# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Coefficients in single precision: nothing that swings freely grows."""

from __future__ import annotations

from hypothesis import given, settings
from hypothesis import strategies as st
import pytest
from tree_sway_lab.methods.branch_bank import single_precision

from tree_sway.core.oscillators.propagation import propagator


@settings(max_examples=200, deadline=None)
@given(ratio=st.floats(1e-4, 1e3), damping=st.floats(0, 0.99))
def test_single_precision_never_lets_free_motion_grow(ratio, damping):
    exact = propagator(1.0, 2 * damping * ratio, ratio * ratio, 1.0)
    row = single_precision(exact)[0].astype(float)
    assert row[0] * row[5] - row[1] * row[4] <= 1.0
    assert row == pytest.approx(exact[0], rel=1.3e-7, abs=1e-37)
