# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Places, winds and time steps of trees on shared tables."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.scene.placed_trees import PlacedTrees
from tree_sway.core.wind import WindProfile

_CROWN = 0.7
"""Height over that of the tree at which its wind is taken."""

_FINEST_SCALE = 0.01
"""Largest relative difference of scales of trees with the same time step."""


class Placements(NamedTuple):
    """Where trees stand: places as x, y, z [m], turn [rad] and scale, (t, 5), and winds, (t,)."""

    places: Floats
    speeds: Floats
    """Wind of each tree over that of its kind, (t,)."""


def placements_of(scene: PlacedTrees, profile: WindProfile) -> Placements:
    """Return where the trees of a scene stand."""
    places = np.array([(tree.x, tree.y, tree.z, tree.yaw, tree.scale) for tree in scene.trees])
    return Placements(places, _wind_ratios(scene, profile))


def kind_heights(scene: PlacedTrees) -> Floats:
    """Heights of the trees' kinds in [m], (t,)."""
    heights = np.array([kind.tree.height for kind in scene.kinds])
    return heights[scene.kind_numbers]


def _wind_ratios(scene: PlacedTrees, profile: WindProfile) -> Floats:
    """Wind at the crown of each tree over that at the crown of its kind, (t,)."""
    scales = np.array([tree.scale for tree in scene.trees])
    crowns = _CROWN * kind_heights(scene)
    of_kind = profile.over_anemometer(profile.ground + crowns)
    of_tree = profile.over_anemometer(profile.ground + crowns * scales)
    return np.divide(of_tree, of_kind, out=np.ones(len(scales)), where=of_kind > 0.0)


def own_step(scale: float, dt: float) -> float:
    """Return the time step [s] of a tree of a scale, rounded as in the native core."""
    return dt / math.exp(round(math.log(scale) / _FINEST_SCALE) * _FINEST_SCALE)
