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
    page_of,
    SECTIONS,
    write_proof,
    write_validation,
)
from tree_sway_lab.validation.section import Check, CHECKS, Effort, Section

from tree_sway.errors import ParameterError
from tree_sway.growth.crown_allometry import AREA_SPREAD
from tree_sway.simulation import strength_band


def test_a_claim_has_a_folder_and_a_row_of_the_page(tmp_path: Path) -> None:
    rows = ''.join(f'| {k} | {k * k} |\n' for k in range(50))
    checks = f'{CHECKS}\n|---|---|---|---|\n' + 41 * '| x | 3 | at most 2 | **misses** |\n'
    text = f'## Slopes\n\nHow it was measured.\n\n{checks}\n| n | square |\n|---|---|\n{rows}'
    write_proof(tmp_path, 'slopes', text, 'Measured on 2026-01-02, commit abc.')
    write_proof(tmp_path, 'models', '## Models\n\n| y | **misses** |\n| z | holds |\n', 'M.')
    readme = (tmp_path / 'proof' / 'slopes' / 'README.md').read_text(encoding='utf-8')
    assert readme.startswith('# Slopes\n\n`tree-sway lab validate --only slopes -o doc`')
    assert checks in readme
    assert '50 rows of n, square: [figures.csv]' in readme
    figures = (tmp_path / 'proof' / 'slopes' / 'figures.csv').read_text(encoding='utf-8')
    assert figures.splitlines()[:2] == ['n,square', '0,0']
    assert figures.count('\n') == 51
    page = (tmp_path / PAGE).read_text(encoding='utf-8')
    first, second = page.splitlines()[-2:]
    assert first == '| `models`: [Models](proof/models/README.md) | 1 | 1 | M |'
    assert second.endswith('(proof/slopes/README.md) | 0 | 41 | 2026-01-02, commit abc |')
    assert page.count('# Validation') == 1


def test_the_first_screen_has_the_spreads_of_the_program() -> None:
    head = page_of(Path('nowhere'))
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

    def stored() -> list[str]:
        page = (tmp_path / PAGE).read_text(encoding='utf-8')
        return re.findall(r'^\| `(\w+)`: \[', page, re.MULTILINE)

    assert stored() == list(SECTIONS[:6])
    assert write_validation(tmp_path, ['slopes']) == ['slopes: x']
    assert stored() == [*SECTIONS[:6], 'slopes']


def test_a_section_that_is_none_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ParameterError, match="no section 'slope'; name one of: kinds"):
        write_validation(tmp_path, ['slope'])
    assert not (tmp_path / PAGE).exists()
