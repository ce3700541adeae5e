# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The section on held-out trees: which of a table it scores, and how."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from tree_sway_lab.validation.section import Effort
from tree_sway_lab.validation.sections.held_out import measure, measured_trees, over_measured

TABLE = """Owner,TreeID,Clade,Clade2,Environment,Source,Species_Latin,H_m,DBH_m,f0,Site
Amanda Bunce,,,Broadleaf,Forest,,Quercus rubra ,18,0.25,0.2,Torrington
Amanda Bunce,,,Broadleaf,Forest,,Carya glabra,27,0.44,0.16,Storrs
Amanda Bunce,,,Broadleaf,Forest,,Quercus rubra,30,0.05,0.2,Torrington
Brian Kane,,,Broadleaf,Open,,Acer Saccarum,18,0.5,0.4,MA
Brian Kane,,,Broadleaf,Open,,Acer Saccarum,18,0.5,,MA
Dirk Schindler,,,Conifer,Open,,Pinus sylvestris,16.8,0.215,0.37,Hartheim
Moore & Maguire 2004,,,Conifer,Forest,,Picea abies,15,0.2,0.36,UK
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / 'frequencies.csv').write_text(TABLE, encoding='utf-8')
    return tmp_path


def test_trees_of_known_species_that_nobody_has_seen_are_scored(folder: Path) -> None:
    trees = measured_trees(folder / 'frequencies.csv')
    assert [(tree.kind, tree.species) for tree in trees] == [
        ('forest', 'oak'), ('forest', 'oak'), ('open', 'maple'), ('conifers', 'pine'),
    ]  # fmt: skip
    assert (trees[0].height, trees[0].diameter, trees[0].frequency) == (18.0, 0.25, 0.2)


def test_a_tree_that_cannot_stand_is_beyond_a_factor_of_2(folder: Path) -> None:
    trees = measured_trees(folder / 'frequencies.csv')
    assert math.isnan(over_measured(trees[1]))
    section = measure(
        Effort(lambda function, items: [function(each) for each in items], data=folder)
    )
    shares = [check.measured for check in section.checks if 'factor of 2' in check.what]
    assert shares[1] == 0.5
    assert '| forest broadleaves | all |  | 2 | 1 |' in section.table


def test_without_the_table_there_is_nothing_to_score() -> None:
    assert measure(Effort(lambda function, items: [])).checks == []
