# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A conifer that stands alone: one straight stem, branches in whorls, a crown of its species' form.

Branches near the ground are the oldest and longest; those near the top are short and point
upwards. Twigs stand left and right of each branch. The stem tapers as ``(1 - z / H)^0.7``, between
a cone and a paraboloid, whatever its branches: its volume is 0.44 to 0.50 of the cylinder of its
height and diameter at breast height, as yield tables have it.
"""

from __future__ import annotations

import numpy as np

from tree_sway_ros.core.growth.axis import direction_of, grow_axis
from tree_sway_ros.core.growth.forms import conifer_form, ConiferForm
from tree_sway_ros.core.growth.skeleton import Skeleton
from tree_sway_ros.core.growth.thickness import BREAST_HEIGHT, node_diameters
from tree_sway_ros.core.growth.twigs import add_twigs
from tree_sway_ros.core.tree.tree import Tree

_UPRIGHT = np.pi / 2.0
STEM_TAPER = 0.7
"""Power of the distance from the top in the diameter of a conifer's stem."""


def grow_conifer(
    rng: np.random.Generator,
    *,
    height: float = 12.0,
    diameter: float = 0.2,
    name: str = 'conifer',
    species: str = 'spruce',
) -> Tree:
    """Grow whorls on a straight stem; arguments as of `grow_broadleaf`."""
    form, skeleton = conifer_form(species), Skeleton()
    bole = form.outline.base
    # As many segments below the crown as go with the whorls above it.
    below = max(1, round(form.n_whorls * bole / (1.0 - bole)))
    n_nodes = below + form.n_whorls
    stem = skeleton.add(
        grow_axis(
            np.zeros(3), 0.0, (_UPRIGHT, _UPRIGHT), 1.0, n_nodes, rng, wander=0.006, unevenness=0.1
        )
    )
    for node in range(below, n_nodes):
        here = (node - below) / form.n_whorls
        whorl = form.whorl if here < 0.8 else form.whorl - 1
        roll = rng.uniform(0.0, 2.0 * np.pi)
        for turn in range(whorl):
            azimuth = roll + 2.0 * np.pi * turn / whorl + rng.uniform(-0.2, 0.2)
            _add_branch(skeleton, stem, node, azimuth, here, form, rng)
    skeleton.scale_to_height(height)
    at_height = BREAST_HEIGHT if height > 2.0 * BREAST_HEIGHT else 0.0
    diameters = node_diameters(
        skeleton,
        diameter,
        at_height=at_height,
        tip_diameter=0.003 * (height / 8.0) ** 0.5,
        exponent=form.exponent,
        stem_taper=STEM_TAPER,
    )
    return skeleton.to_tree(diameters, name, species)


def _add_branch(
    skeleton: Skeleton,
    stem: int,
    at: int,
    azimuth: float,
    here: float,
    form: ConiferForm,
    rng: np.random.Generator,
) -> None:
    """Add a branch at a height of the crown from 0 to 1, as long as the crown is wide there."""
    origin = skeleton.shoots[stem].nodes[at]
    low, high = form.rise
    first = low + (high - low) * here + rng.uniform(-0.08, 0.08)
    heading = direction_of(azimuth, first + 0.5 * form.turn)
    length = max(form.outline.reach(origin, heading), 0.012) * rng.uniform(0.85, 1.08)
    n_segments = 6 if here < 0.7 else 4 if here < 0.9 else 2
    nodes = grow_axis(
        origin,
        azimuth,
        (first, first + form.turn),
        length,
        n_segments,
        rng,
        wander=form.wander,
        floor=0.01,
    )
    branch = skeleton.add(nodes, stem, at)
    if n_segments > 2:
        add_twigs(
            skeleton,
            branch,
            length=0.01 + form.twig * length,
            polar=0.85,
            sides=(0.0, np.pi),
            first_node=2,
            lift=form.lift,
            outer_ratio=0.65,
        )
