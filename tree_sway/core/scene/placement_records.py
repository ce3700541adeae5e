# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Records of trees on shared tables: their places and time steps."""

from __future__ import annotations

import math

import numpy as np

from tree_sway.core.arrays import Floats, Ints, Records
from tree_sway.core.run.stand import PLACEMENT
from tree_sway.core.scene.placed_trees import PlacedTrees
from tree_sway.core.wind.height_profile import WindProfile

_CROWN = 0.7
"""Height over that of the tree at which its wind is taken."""

_FINEST_SCALE = 0.01
"""Largest relative difference of scales of trees with the same time step."""


def placements_of(scene: PlacedTrees, tables: Ints, profile: WindProfile) -> Records:
    """Make the records of a scene's trees by their tables, (t,)."""
    places = np.array([(each.x, each.y, each.z, each.yaw, each.scale) for each in scene.trees])
    return placement_records(tables, places, _wind_ratios(scene, profile))


def kind_heights(scene: PlacedTrees) -> Floats:
    """Heights of the trees' kinds in [m], (t,)."""
    return np.array([each.tree.height for each in scene.kinds])[scene.kind_numbers]


def _wind_ratios(scene: PlacedTrees, profile: WindProfile) -> Floats:
    """Wind at the crown of each tree over that at the crown of its kind, (t,)."""
    scales = np.array([each.scale for each in scene.trees])
    relative = np.stack([np.ones(len(scales)), scales])
    crowns = profile.ground + _CROWN * kind_heights(scene) * relative
    of_kind, of_tree = profile.over_anemometer(crowns)
    has_wind = of_kind > 0.0
    return np.where(has_wind, of_tree / np.where(has_wind, of_kind, 1.0), 1.0)


def placement_records(kinds: Ints, places: Floats, speeds: Floats) -> Records:
    """
    Make the records of trees by their tables, places and winds.

    Places are x, y, z [m], turn about the vertical [rad] and scale, (t, 5); winds are those of
    the trees over those of their kinds, (t,).
    """
    rows: Records = np.zeros(len(places), dtype=PLACEMENT)
    rows['kind'], rows['at'] = kinds, places[:, :3]
    rows['scale'], rows['speed'] = places[:, 4], speeds
    rows['cosine'], rows['sine'] = np.cos(0.5 * places[:, 3]), np.sin(0.5 * places[:, 3])
    return rows


def own_steps(kinds: Ints, scales: Floats, dt: float) -> tuple[list[tuple[int, float]], Ints]:
    """Return the kinds and time steps [s] for a step of the scene, and that of each tree."""
    steps = np.rint(np.log(scales) / _FINEST_SCALE)
    pairs = np.stack([kinds, steps], axis=1)
    found, number = np.unique(pairs, axis=0, return_inverse=True)
    own = [(int(kind), dt / math.exp(step * _FINEST_SCALE)) for kind, step in found.tolist()]
    return own, number.ravel()
