# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""T18: adversarial runs."""

from __future__ import annotations

import numpy as np
import pytest

from tree_sway_ros.study.battery.rows import t18_adversary as case


def test_every_row_is_as_it_should_be():
    rows = case.run()
    assert rows
    assert [row for row in rows if not row.good] == []


@pytest.mark.long
def test_every_row_in_full():
    rows = case.run(full=True)
    assert rows
    assert [row for row in rows if not row.good] == []


def test_the_bound_is_the_resonance_of_a_switching_load():
    assert case.bound(np.array([0.01])) == pytest.approx([2 / (np.pi * 0.01)], rel=1e-3)
    assert case.bound(np.array([1.0])) == pytest.approx([1.0])
