# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A check holds between its limits and says so; a section is Markdown on the page."""

from __future__ import annotations

import pytest
from tree_sway_lab.validation.section import Check, markdown_table, Section


@pytest.mark.parametrize(
    ('check', 'row'),
    [
        (Check('error', 0.03, high=0.05), '| error | 0.03 | at most 0.05 | holds |'),
        (Check('error', 0.0512, high=0.05), '| error | 0.0512 | at most 0.05 | **misses** |'),
        (Check('share', 0.3, low=0.3), '| share | 0.3 | at least 0.3 | holds |'),
        (Check('slope', -6.5, -6.2, -2.0), '| slope | -6.5 | -6.2 to -2 | **misses** |'),
    ],
)
def test_a_check_reports_figure_limit_and_whether_it_holds(check: Check, row: str) -> None:
    assert check.row() == row


def test_a_figure_that_is_none_does_not_hold() -> None:
    assert not Check('error', float('nan'), high=1.0).holds


def test_a_section_has_its_checks_and_its_table() -> None:
    table = markdown_table(['a', 'b'], [['1', '2']])
    assert table == '| a | b |\n|---|---|\n| 1 | 2 |\n'
    text = Section('Title', 'How.', [Check('x', 1.0, high=2.0)], table).markdown()
    assert text.startswith(
        '## Title\n\nHow.\n\n| check | measured | limit | |\n|---|---|---|---|\n'
    )
    assert text.endswith(table)
