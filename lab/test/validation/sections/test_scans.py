# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""First frequencies of files within 3 % of the frame's, at a shear modulus of E/14."""

from __future__ import annotations

from pathlib import Path
import shutil

import pytest
from tree_sway_lab.validation.section import Effort
from tree_sway_lab.validation.sections.scans import first_frequencies, LIMIT, measure

ROOT = Path(__file__).resolve().parents[4]
SHARED = ROOT.parent / 'shared' / 'data' / 'trees'
OURS = ROOT / 'test' / 'files' / 'data' / 'tree121.csv'

STANDING = (
    'qsm_archi.csv', 'qsm_simpleforest.csv', 'qsm_treeqsm_v5.mat',
    'sapling.csv', 'tree121.csv', 'tree121.simpleforest.csv',
    pytest.param('qsm_treeqsm_2.3.txt', marks=pytest.mark.long),
    pytest.param('qsm_treeqsm_struct.mat', marks=pytest.mark.long),
    pytest.param('walnut.mtg', marks=pytest.mark.long),
)  # fmt: skip


@pytest.mark.parametrize('name', STANDING)
def test_a_scan_sways_as_often_as_its_frame(name: str) -> None:
    if not (SHARED / name).is_file():
        pytest.skip(f'no {name} beside the repository, in ../shared/data/trees')
    found = first_frequencies(SHARED / name)
    assert found.has_weight
    assert found.model == pytest.approx(found.frame, rel=LIMIT)


def test_the_section_has_a_check_per_tree_that_can_stand(tmp_path: Path) -> None:
    (tmp_path / 'trees').mkdir()
    shutil.copy(OURS, tmp_path / 'trees')
    (tmp_path / 'trees' / 'tree.LICENSE').write_text('own')
    section = measure(Effort(lambda f, items: [f(item) for item in items], data=tmp_path))
    (check,) = section.checks
    assert check.what == '`tree121.csv`, relative error'
    assert check.holds
    assert '| tree121.csv | 121 | 726 | yes |' in section.table


def test_without_data_there_is_nothing_to_check() -> None:
    assert not measure(Effort(lambda f, items: [f(item) for item in items])).checks
