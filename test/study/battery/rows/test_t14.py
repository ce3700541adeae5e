# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""T14: a redundant constraint."""

from __future__ import annotations

from tree_sway_ros.study.battery.rows import t14_redundant_pin as case


def test_every_row_is_as_it_should_be():
    rows = case.run()
    assert rows
    assert [row for row in rows if not row.good] == []
