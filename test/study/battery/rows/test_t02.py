# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""T2: no numerical damping, no wrong frequency."""

from __future__ import annotations

import numpy as np
import pytest

from tree_sway_ros.study.battery.rows import t02_damping as case


def test_every_row_is_as_it_should_be():
    rows = case.run()
    assert rows
    assert [row for row in rows if not row.good] == []


def test_the_fit_finds_what_was_put_in():
    t = np.arange(200) * 0.01
    w, z = 2 * np.pi * 3.0, 0.07
    decay = np.exp(-z * w * t) * np.cos(w * np.sqrt(1 - z * z) * t + 0.3)
    assert case.fit(decay, 0.01) == pytest.approx((3.0, 0.07), rel=1e-9)
