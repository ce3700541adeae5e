# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""T15: late and uneven steps."""

from __future__ import annotations

from tree_sway_ros.study.battery.rows import t15_stalls as case


def test_every_row_is_as_it_should_be():
    rows = case.run()
    assert rows
    assert [row for row in rows if not row.good] == []


def test_uneven_steps_hold_their_stalls():
    steps = case.uneven_steps(180)
    assert (steps == case.STALL).sum() == 3
    assert steps.min() > 0
