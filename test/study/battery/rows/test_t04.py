# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""T4: limits of Baumgarte's gain."""

from __future__ import annotations

import numpy as np

from tree_sway_ros.study.battery.rows import t04_gains as case


def test_every_row_is_as_it_should_be():
    rows = case.run()
    assert rows
    assert [row for row in rows if not row.good] == []


def test_a_gain_beyond_the_limit_blows_up():
    assert np.isinf(case.largest_gap('semi_implicit_euler', 0.9))
    assert case.largest_gap('semi_implicit_euler', 0.8) < 1e-2
