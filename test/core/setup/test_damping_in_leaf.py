# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Damping of grown trees in leaf that a wind bends and lets go, that of the still air included.

Unpruned Douglas-firs had a ratio of 0.08 and more (Moore & Maguire 2005, Trees 19, 363-373).
"""

from __future__ import annotations

import numpy as np
import pytest

from tree_sway.core.growth.grow import grow
from tree_sway.core.model.settings import Settings
from tree_sway.core.scene.simulate import Rig

RATE = 60.0
BENT, CYCLES = 20.0, 2.5
"""How long the wind blows [s], and cycles after it."""


@pytest.mark.parametrize(('name', 'height'), [('douglas_fir', 15.0), ('beech', 15.0)])
def test_a_tree_in_leaf_that_is_let_go_is_damped_as_measured(name: str, height: float) -> None:
    tree = grow(name, height, rng=np.random.default_rng(4))
    rig = Rig(tree, Settings(model=20, in_leaf=True))
    first = rig.reductions.natural_frequencies(1)[0]
    for speed in (3.0, 10.0):
        wind = np.zeros((round(RATE * (BENT + CYCLES / first)), 3))
        wind[: round(RATE * BENT), 0] = speed
        strain = rig.run(wind, rate=RATE).base_strain[round(RATE * BENT) :, 0]
        rises = np.diff(strain * np.sign(strain[0])) > 0.0
        crests = np.abs(strain[1:-1][rises[:-1] & ~rises[1:]])
        # The first cycle has other modes as well.
        ratio = np.log(crests[0] / crests[1]) / (2.0 * np.pi)
        print(f'{name}, let go by {speed:g} m/s: {ratio:.3f}')
        assert 0.08 <= ratio <= 0.12
