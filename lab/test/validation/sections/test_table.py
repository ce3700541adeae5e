# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The section on the table of winds: what it measures, and what misses."""

from __future__ import annotations

from pathlib import Path

import pytest
from tree_sway_lab.validation.section import Effort
from tree_sway_lab.validation.sections.table import (
    APART,
    Departure,
    departure,
    HANGING,
    limb_by_limb,
    LIMIT,
    measure,
)

OURS = Path(__file__).resolve().parents[4] / 'test' / 'files' / 'data' / 'tree121.csv'


def test_a_tree_that_is_too_far_from_modes_misses(tmp_path: Path) -> None:
    (tmp_path / 'trees').mkdir()
    (tmp_path / 'trees' / 'walnut.mtg').touch()

    def each(function, sources):
        if function is limb_by_limb:
            return [[0.01, APART + 0.01 * (source == HANGING[1])] for source in sources]
        return [
            Departure(9, [LIMIT + 0.01 * source.endswith('.mtg')] * 4, [0.5] * 4, [0.1] * 4)
            for source in sources
        ]

    section = measure(Effort(each, data=tmp_path))
    *trees, over, apart, hanging = section.checks
    missed = [check.what for check in trees if not check.holds]
    assert len(trees) == 4
    assert missed == ['`walnut.mtg`, largest error over motion']
    assert over.holds
    assert apart.holds
    assert not hanging.holds
    assert '| walnut.mtg | 9 | 0.040 | 0.040 | 0.040 | 0.040 | 0.50 | 0.100 |' in section.table


@pytest.mark.long
def test_a_tree_on_its_table_sways_as_its_modes() -> None:
    found = departure(str(OURS))
    assert found.branches == 121
    assert max(found.errors) < LIMIT
    assert 0.0 < max(found.over_estimates) < 1.0
    assert max(found.outside) == 0.0
