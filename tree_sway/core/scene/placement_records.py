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
    places = np.array([(tree.x, tree.y, tree.z, tree.yaw, tree.scale) for tree in scene.trees])
    return placement_records(tables, places, _wind_ratios(scene, profile))


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


def placement_records(kinds: Ints, places: Floats, speeds: Floats) -> Records:
    """
    Make the records of trees by their tables, places and winds.

    Places are x, y, z [m], turn about the vertical [rad] and scale, (t, 5); winds are those of
    the trees over those of their kinds, (t,).
    """
    half_turn = 0.5 * places[:, 3]
    rows: Records = np.zeros(len(places), dtype=PLACEMENT)
    rows['kind'] = kinds
    rows['at'] = places[:, :3]
    rows['scale'] = places[:, 4]
    rows['speed'] = speeds
    rows['cosine'] = np.cos(half_turn)
    rows['sine'] = np.sin(half_turn)
    return rows


def own_steps(kinds: Ints, scales: Floats, dt: float) -> tuple[list[tuple[int, float]], Ints]:
    """Return the kinds and time steps [s] for a step of the scene, and that of each tree."""
    scale_numbers = np.rint(np.log(scales) / _FINEST_SCALE)
    pairs = np.stack([kinds, scale_numbers], axis=1)
    found, number_of_pair = np.unique(pairs, axis=0, return_inverse=True)
    own = []
    for kind, scale_number in found.tolist():
        scale = math.exp(scale_number * _FINEST_SCALE)
        own.append((int(kind), dt / scale))
    return own, number_of_pair.ravel()
