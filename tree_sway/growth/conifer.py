# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A conifer in the open: one straight stem, branches in whorls, a crown of its species' form.

Branches near the ground are the oldest and longest; those near the top are short and point
upwards. Twigs are left and right of each branch. The stem tapers as ``(1 - z / H)^0.7``, between a
cone and a paraboloid, whatever its branches. Its volume is 0.44 to 0.50 of the cylinder of its
height and diameter at breast height, as in yield tables.
"""

from __future__ import annotations

import numpy as np

from tree_sway.core.tree import Tree
from tree_sway.growth.axis import direction_of, grow_axis
from tree_sway.growth.forms import conifer_form, ConiferForm
from tree_sway.growth.skeleton import Skeleton
from tree_sway.growth.thickness import finished_tree
from tree_sway.growth.twigs import add_twigs

_UPRIGHT = (np.pi / 2.0, np.pi / 2.0)
_STEM_TAPER = 0.7
"""Exponent of the distance from the top in the diameter of a conifer's stem."""


def grow_conifer(
    rng: np.random.Generator,
    height: float = 12.0,
    diameter: float = 0.2,
    species: str = 'spruce',
    form: ConiferForm | None = None,
) -> Tree:
    """Grow whorls on a straight stem; arguments are those of `grow_broadleaf`."""
    form = form or conifer_form(species)
    skeleton = Skeleton()

    def add_branch(at: int, azimuth: float, here: float) -> None:
        """Add a branch at a height of the crown from 0 to 1, as long as the crown is wide."""
        origin = skeleton.shoots[stem].nodes[at]
        low, high = form.rise
        first = low + (high - low) * here + rng.uniform(-0.08, 0.08)
        heading = direction_of(azimuth, first + 0.5 * form.turn)
        length = max(form.outline.room(origin, heading), 0.012) * rng.uniform(0.85, 1.08)
        segments = 6 if here < 0.7 else 4 if here < 0.9 else 2
        ends = (first, first + form.turn)
        wander = form.wander
        axis = grow_axis(origin, azimuth, ends, length, segments, rng, wander=wander, floor=0.01)
        branch = skeleton.add(axis, stem, at)
        twig = 0.01 + form.twig * length
        if segments > 2:
            more = {'lift': form.lift, 'outer_ratio': 0.65}
            add_twigs(skeleton, branch, twig, 0.85, (0.0, np.pi), first_node=2, **more)

    bole = form.outline.base
    # Segments below the crown are as long as those of the whorls above it.
    below = max(1, round(form.n_whorls * bole / (1.0 - bole)))
    n_nodes = below + form.n_whorls
    straight = {'wander': 0.006, 'unevenness': 0.1}
    stem = skeleton.add(grow_axis(np.zeros(3), 0.0, _UPRIGHT, 1.0, n_nodes, rng, **straight))
    for node in range(below, n_nodes):
        here = (node - below) / form.n_whorls
        whorl = form.whorl if here < 0.8 else form.whorl - 1
        roll = rng.uniform(0.0, 2.0 * np.pi)
        for turn in range(whorl):
            azimuth = roll + 2.0 * np.pi * turn / whorl + rng.uniform(-0.2, 0.2)
            add_branch(node, azimuth, here)
    law = {'exponent': form.exponent, 'stem_taper': _STEM_TAPER}
    return finished_tree(skeleton, height, diameter, species, **law)
