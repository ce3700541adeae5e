# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Wood keeps its drag, leaves alone streamline."""

from __future__ import annotations

import numpy as np
import pytest

from tree_sway_ros.core.growth.grow import grow
from tree_sway_ros.core.motion.drag import AIR_DENSITY, SHARED_AT, crown_drag, pressure
from tree_sway_ros.core.simulator.assembly import CalibratedTree
from tree_sway_ros.core.simulator.settings import Settings
from tree_sway_ros.core.tree.species import species_named

SPEEDS = np.array([4.0, 6.0, 8.0, 10.0, 12.0, 15.0, 20.0])


def test_a_crown_bears_the_load_of_its_wood_and_of_its_leaves():
    law, weight = crown_drag(3.0, 7.0, 1.2, (2.5, 0.85))
    for speed in SPEEDS:
        both = 0.5 * AIR_DENSITY * (1.2 * 3.0 + 2.5 * speed**-0.85 * 7.0)
        assert pressure(speed, *law) * (3.0 + weight * 7.0) == pytest.approx(both)
    # At one speed every branch bears its own share, however many leaves it has.
    leafy, bare = 0.4 + weight * 2.0, 0.9
    shared = pressure(SHARED_AT, *law)
    of_leaves = 0.5 * AIR_DENSITY * 2.5 * SHARED_AT**-0.85
    assert shared * bare == pytest.approx(0.5 * AIR_DENSITY * 1.2 * 0.9)
    assert shared * leafy == pytest.approx(0.5 * AIR_DENSITY * 1.2 * 0.4 + of_leaves * 2.0)


@pytest.mark.parametrize("species", ["oak", "beech", "birch", "spruce", "pine"])
def test_leaves_add_load_and_let_it_grow_as_in_the_field(species):
    """Angelou, Dellwik & Mann (2019): the power of the speed is 1.60 to 1.68, leaves double it."""
    tree, wood = grow(species, 12.0, rng=np.random.default_rng(1)), species_named(species)
    area = tree.length @ (tree.base_diameter + tree.tip_diameter) / 2.0
    loads = []
    for in_leaf in (True, False):
        crown = CalibratedTree(tree, wood, Settings(in_leaf=in_leaf))
        leaves = crown.leaf_load_area.sum() if in_leaf else 0.0
        pressures = np.array([pressure(speed, *crown.drag_law) for speed in SPEEDS])
        loads.append(pressures * SPEEDS**2 * (area + leaves))
    power = np.polyfit(np.log(SPEEDS), np.log(loads[0]), 1)[0]
    assert 1.5 <= power <= 1.7
    ratio = loads[0] / loads[1]
    assert 1.7 <= ratio[1] <= 3.4
    assert ratio[-1] >= 1.2
