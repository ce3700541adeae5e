# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Places that tell most are found, and each leaves less than those before it."""

from __future__ import annotations

import numpy as np

from tree_sway.core.scene.make import make_simulator
from tree_sway.core.species.species import species_named
from tree_sway.growth.growing import grow
from tree_sway.twin.sensor_advice import advised_places
from tree_sway.twin.sensor_place import place_on


def test_a_tree_with_a_stem_has_its_first_sensor_high_on_it() -> None:
    spruce = grow('spruce', 4.0, rng=np.random.default_rng(6))
    simulator = make_simulator(spruce, species_named('spruce'), in_leaf=False)
    first, second = advised_places(simulator, 2)
    assert first.at in ('stem:0.6', 'stem:0.8')
    assert place_on(simulator.tree, second.at) != place_on(simulator.tree, first.at)
    assert 0.0 < second.left < first.left < 0.6
