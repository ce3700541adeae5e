# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Damping of grown trees in leaf that a wind bends and lets go, that of the still air included.

Unpruned Douglas-firs had a ratio of 0.08 and more (Moore & Maguire 2005, Trees 19, 363-373), and
Norway maples in leaf 1.5 +- 0.3 times that without (Netsvetov & Nikulina 2010, Dendrobiology 64,
37-42).
"""

from __future__ import annotations

import numpy as np
import pytest

from tree_sway.core.settings import Settings
from tree_sway.growth.growing import grow
from tree_sway.simulation.rig import Rig

RATE = 60.0
BENT, CYCLES = 20.0, 6.0
"""How long the wind blows [s], and cycles after it."""


def _damping(name: str, speed: float, *, in_leaf: bool, crests: int) -> float:
    """Damping ratio of a tree of 15 m that a wind [m/s] bent, from its first crests [-]."""
    tree = grow(name, 15.0, rng=np.random.default_rng(4))
    rig = Rig(tree, Settings(model=20, in_leaf=in_leaf))
    first = rig.reductions.natural_frequencies(1)[0]
    wind = np.zeros((round(RATE * (BENT + CYCLES / first)), 3))
    wind[: round(RATE * BENT), 0] = speed
    strain = rig.run(wind, rate=RATE).base_strain[round(RATE * BENT) :, 0]
    rises = np.diff(strain * np.sign(strain[0])) > 0.0
    heights = np.abs(strain[1:-1][rises[:-1] & ~rises[1:]])
    # The first half cycle has other modes as well.
    decrement = np.log(heights[0] / heights[crests - 1]) / (crests - 1)
    return float(decrement / (2.0 * np.pi))


@pytest.mark.parametrize('speed', [3.0, pytest.param(10.0, marks=pytest.mark.long)])
def test_a_fir_in_needles_that_is_let_go_is_damped_as_measured(speed: float) -> None:
    assert 0.08 <= _damping('douglas_fir', speed, in_leaf=True, crests=2) <= 0.12


@pytest.mark.parametrize('name', ['maple', pytest.param('beech', marks=pytest.mark.long)])
def test_leaves_damp_a_broadleaf_as_much_more_as_measured(name: str) -> None:
    in_leaf, bare = (_damping(name, 10.0, in_leaf=leaves, crests=5) for leaves in (True, False))
    ratio = in_leaf / bare
    print(f'{name}: {bare:.3f} bare, {in_leaf:.3f} in leaf')
    assert 1.2 <= ratio <= 1.8
