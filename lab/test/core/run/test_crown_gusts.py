# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A table meets gusts limb by limb as all coordinates do."""

from __future__ import annotations

import pytest
from tree_sway_lab.bench.sizes import against
from tree_sway_lab.validation.crooked_trees import crooked_tree
from tree_sway_lab.validation.truth import WOOD
from tree_sway_lab.validation.winds import turbulent

from tree_sway.core.scene.make import make_simulator
from tree_sway.core.settings import Settings


@pytest.fixture(scope='module')
def tree():
    return crooked_tree(4)


@pytest.mark.parametrize('speed', [3.0, 9.0])
def test_a_table_meets_the_gusts_limb_by_limb(tree, speed):
    settings = Settings(crown_coherence=0.3)
    full, table = (make_simulator(tree, WOOD, settings, model=each) for each in ('full', 60))
    wind = turbulent(speed, 12.0, 3)
    assert against(table, full, wind) < 0.03  # 0.3 to 0.5 with the mean of the limbs' winds
