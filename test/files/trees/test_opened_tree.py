# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""An opened tree goes as it is into whatever takes trees."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import tree_sway as sway

SEEDLING = Path(__file__).parents[1] / 'data' / 'seedling.yaml'


@pytest.fixture(scope='module')
def opened():
    found = sway.open_tree(SEEDLING)
    return replace(found, species=replace(found.species, modulus=2.0 * found.species.modulus))


def test_it_brings_its_species(opened):
    one = sway.make_simulator(opened, model='branch')
    other = sway.make_simulator(opened.tree, opened.species, model='branch')
    assert one.frequencies(1) == other.frequencies(1)


def test_an_evergreen_of_a_file_is_in_leaf(opened):
    spruce = replace(opened, species=sway.species_named('spruce'))
    assert sway.make_simulator(spruce, model='branch').settings.in_leaf is True


def test_it_is_simulated_calibrated_and_written(opened, tmp_path):
    wind = np.full((3, 3), 4.0)
    record = sway.simulate(opened, wind, model='branch')
    of_the_table = sway.simulate(opened.tree, wind, model='branch')
    assert not np.array_equal(record.tips, of_the_table.tips)
    assert sway.calibrate(opened, None, 5.0).species.key == 'oak'
    sway.write_tree(tmp_path / 'tree.yaml', opened)
    again = sway.open_tree(tmp_path / 'tree.yaml')
    assert again.species.modulus == opened.species.modulus
