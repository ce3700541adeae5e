# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""T1: energy of free motion never grows; the classic methods die."""

from __future__ import annotations

import pytest

from tree_sway_ros.study.battery.rows import t01_free_decay as case
from tree_sway_ros.study.methods.registry import method_named


def test_every_row_is_as_it_should_be():
    rows = case.run()
    assert rows
    assert [row for row in rows if not row.good] == []


@pytest.mark.long
def test_every_row_in_full():
    rows = case.run(full=True)
    assert rows
    assert [row for row in rows if not row.good] == []


def test_energy_that_grows_is_seen():
    assert case.growth(method_named('semi_implicit_euler'), 2.1, 0.0, 200, 1e-2, float) > 1.0
    assert case.growth(method_named('rk4'), 1.0, 0.0, 200, 1e-2, float) <= 0.0
