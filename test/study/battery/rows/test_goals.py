# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Goals of the default integrator."""

from __future__ import annotations

from tree_sway_ros.study.battery.rows import goals as case


def test_every_row_is_as_it_should_be():
    rows = case.run()
    assert rows
    assert [row for row in rows if not row.good] == []


def test_a_frame_of_many_branches_is_timed():
    assert case.milliseconds_a_frame(1600, 3) > 0.0
