# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The page: sections in order, each replaced by itself, and still there when a later one fails."""

from __future__ import annotations

import math
from pathlib import Path
import re

import pytest
from tree_sway_lab.validation import report
from tree_sway_lab.validation.report import (
    PAGE,
    SECTIONS,
    sections_of,
    with_section,
    write_validation,
)
from tree_sway_lab.validation.section import Check, Effort, Section

from tree_sway.core.tree.crown_allometry import AREA_SPREAD
from tree_sway.errors import ParameterError
from tree_sway.simulation import strength_band


def test_sections_stand_in_order_and_are_replaced_alone() -> None:
    page = with_section('', 'slopes', '| x | **misses** |\n')
    page = with_section(page, 'models', '| x | holds |\n| y | holds |\n')
    assert list(sections_of(page)) == ['models', 'slopes']
    assert '| models | 2 | 0 |\n| slopes | 0 | 1 |' in page
    again = with_section(page, 'slopes', '| x | holds |\n')
    assert sections_of(again)['models'] == sections_of(page)['models']
    assert '| slopes | 1 | 0 |' in again
    assert again.count('# Validation') == 1


def test_the_first_screen_has_the_spreads_of_the_program() -> None:
    head = with_section('', 'slopes', '')
    (budget,) = (line for line in head.splitlines() if line.startswith('| 0.02 | '))
    cells = [float(re.match(r'[\d.]+', cell.strip()).group()) for cell in budget.split('|')[1:-1]]
    roots = math.hypot(strength_band.ROOTS_OF_A_SPECIES, strength_band.ROOTS_OF_SPECIES)
    found = [strength_band.WOOD, strength_band.DRAG, strength_band.LEAVES, AREA_SPREAD, roots]
    assert cells[1:] == [*(round(each, 2) for each in found), strength_band.WIND]


def test_every_section_has_a_module_that_measures() -> None:
    folder = Path(report.__file__).parent / 'sections'
    files = {file.stem for file in folder.glob('*.py')} - {'__init__'}
    assert files == set(SECTIONS)


def test_what_was_measured_stays_when_a_later_section_fails(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def measured(name: str, effort: Effort) -> Section:
        if name == 'gust':
            raise RuntimeError
        return Section(name, 'How.', [Check('x', 3.0, high=2.0)])

    monkeypatch.setattr(report, 'measured', measured)
    with pytest.raises(RuntimeError):
        write_validation(tmp_path)
    stored = sections_of((tmp_path / PAGE).read_text(encoding='utf-8'))
    assert list(stored) == list(SECTIONS[:6])
    assert write_validation(tmp_path, ['slopes']) == ['slopes: x']
    stored = sections_of((tmp_path / PAGE).read_text(encoding='utf-8'))
    assert list(stored) == [*SECTIONS[:6], 'slopes']


def test_a_section_that_is_none_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ParameterError, match="no section 'slope'; name one of: kinds"):
        write_validation(tmp_path, ['slope'])
    assert not (tmp_path / PAGE).exists()
