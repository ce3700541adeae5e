# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Gusts that reach the limbs of a tree one after another.

Models that step branches give each limb its own wind. `wind_basis` has uniform winds only, and
uses the mean of the limbs' winds, weighted by their loads.
"""

from __future__ import annotations

import numpy as np

from tree_sway.core.arrays import Floats, Records
from tree_sway.core.motion.plain.numpy_passes import into_slots
from tree_sway.core.simulator.reductions import TreeReductions
from tree_sway.core.tree.tree import Tree
from tree_sway.core.wind.crown_wind import crown_delays, CrownDelays, CrownWind


def delays_of(tree: Tree, leaf_area: Floats) -> CrownDelays:
    """Assign delays to the branches of a tree, with leaves equivalent to areas (b,) of wood."""
    first = tree.branch_first[:-1]
    area = tree.length * 0.5 * (tree.base_diameter + tree.tip_diameter)
    middle = 0.5 * (tree.start + tree.end) * area[:, None]
    wood = np.add.reduceat(area, first)
    centre = np.add.reduceat(middle, first, axis=0) / np.maximum(wood, 1e-12)[:, None]
    return crown_delays(tree.branch_parent, centre, wood + leaf_area)


class CrownGusts:
    """The wind of a crown and the loads it acts on; None for a model of uniform winds."""

    def __init__(self, reductions: TreeReductions, loads: Records | None) -> None:
        """Start without wind."""
        settings = reductions.settings
        whole = delays_of(reductions.tree, reductions.leaf_load_area)
        pieces = reductions.reduced(settings.model).branch
        self._delays = delays = whole._replace(of_branch=whole.of_branch[pieces])
        self.wind, self._loads = CrownWind(delays.spread, settings.crown_coherence), loads

    def winds_of_step(self, x: float, y: float, z: float, dt: float) -> tuple[float, float, float]:
        """
        Set the limbs' winds by the mean wind [m/s] of a step of dt [s]; return the wind to use.

        That is the given wind, or the mean of the limbs' winds for a model of uniform winds.
        """
        apart = self.wind.push(x, y, z, dt)
        if self._loads is not None:
            into_slots(apart[self._delays.of_branch], self._loads['gust'])
            return x, y, z
        ax, ay, az = (self._delays.share @ apart).tolist()
        return x + ax, y + ay, z + az
