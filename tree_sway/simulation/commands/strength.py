# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Trees of a scene whose used strength commands report: the tallest of each kind."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from tree_sway.core.scene import PlacedTree, Scene
from tree_sway.core.settings import Settings
from tree_sway.simulation import Exposure, Rig, StrengthUse
from tree_sway.simulation.commands.exposure import chosen_exposure, touched_species


def tallest_of_kinds(scene: Scene) -> dict[int, PlacedTree]:
    """Return the tallest tree of each kind by the number of the kind."""
    by_height = sorted(range(len(scene.trees)), key=lambda row: scene.trees[row].scale)
    return {int(scene.kind_numbers[row]): scene.trees[row] for row in by_height}


def used_strength(
    tree: PlacedTree, settings: Settings, arguments: argparse.Namespace, speeds: Sequence[float]
) -> tuple[Exposure, list[StrengthUse]]:
    """
    Return where a tree stands, and the strength that it uses at mean wind speeds [m/s].

    The wind blows along the axis x of the tree itself: trees of an inventory have random yaws, and
    a crown bends its stem by some hundredths more or less from different sides.
    """
    placed = replace(tree, yaw=0.0).placed()
    exposure = chosen_exposure(arguments, placed, tree.species)
    settings = replace(
        settings, in_leaf=settings.in_leaf if tree.leaf_on is None else tree.leaf_on,
        profile=exposure.profile(float(placed.start[0, 2])),
    )  # fmt: skip
    species = touched_species(exposure, tree.species, tree.learned)
    rig = Rig(PlacedTree(tree.name, placed, species=species), settings)
    rng = np.random.default_rng(0)
    return exposure, rig.strength_curve(speeds, rng=rng, **exposure.turbulence)
