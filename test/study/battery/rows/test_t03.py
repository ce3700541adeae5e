# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""T3: the constraint does not drift."""

from __future__ import annotations

import numpy as np
import pytest

from tree_sway_ros.study.battery.rows import t03_drift as case


def test_every_row_is_as_it_should_be():
    rows = case.run()
    assert rows
    assert [row for row in rows if not row.good] == []


@pytest.mark.long
def test_every_row_in_full():
    rows = case.run(full=True)
    assert rows
    assert [row for row in rows if not row.good] == []


def test_the_slope_is_read_off_the_last_two_decades():
    marks = np.geomspace(1, 1e6, 40)
    assert case.drift_slope(marks, 1e-9 * marks**1.5 + 1e-9) == pytest.approx(1.5, abs=1e-3)
