# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Leaves over the year, for a tree in central Europe; in the south it is half a year later.

Oaks turn on 19 October (mean of 2011 to 2023, Deutscher Wetterdienst, phenological clock); leaves
unfold in late April and fall within a month about early November, in round numbers. Every
deciduous species follows this one calendar.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tree_sway.core.checks import within
from tree_sway.core.leaves import foliage_of, stem_section
from tree_sway.core.species import Color, Look, Species
from tree_sway.core.tree import Tree

FIRST_MONTH, LAST_MONTH, SUMMER = 1.0, 13.0, 7.5
"""Begin and end of the year, and a time when trees are in full leaf, in months from 1."""
HALF_YEAR = 6.0
"""Time by which the seasons south of the equator are apart, in months."""

_UNFOLDING = (4.6, 5.5)
_YOUNG = (4.6, 6.2)
_TURNING = (9.9, 10.9)
_FALL = (10.5, 11.7)
"""Begin and end of each phase, in months."""
_BARE = 0.02
"""Share of the leaves below which a tree is bare."""


def leaf_share(species: Species, month: float) -> float:
    """
    Share of the leaves of summer that a tree bears, 0 to 1; evergreen species keep theirs.

    Raises a `ParameterError` for a month outside the year.
    """
    within('month', month, FIRST_MONTH, LAST_MONTH)
    if species.leaves.is_evergreen:
        return 1.0
    unfolded = _passed(_UNFOLDING, month)
    fallen = _passed(_FALL, month)
    return unfolded * (1.0 - fallen)


def is_bare(species: Species, month: float) -> bool:
    """Whether a tree has no leaves to speak of."""
    return leaf_share(species, month) < _BARE


def species_in_month(species: Species, tree: Tree, month: float) -> Species:
    """
    Return the species of one tree as it is in a month.

    Area, mass and colours of the leaves are those of the month, the damping lies between bare and
    in leaf by the share of the leaves. The drag law is that of the crown in leaf, of less area.
    """
    share = leaf_share(species, month)
    colored = replace(species, look=_look_in_month(species, month))
    if share == 1.0 or is_bare(species, month):
        return colored
    area_in_summer = float(foliage_of(tree, traits=species.leaves).area.sum())
    area_per_section = share * area_in_summer / stem_section(tree)
    added_damping = share * (species.damping_in_leaf - species.damping_bare)
    return replace(
        colored,
        leaves=replace(species.leaves, area_per_section=area_per_section),
        damping_in_leaf=species.damping_bare + added_damping,
    )


def _look_in_month(species: Species, month: float) -> Look:
    """Young leaves are fresh, old ones turn."""
    look = species.look
    if species.leaves.is_evergreen:
        return look
    young = 1.0 - _passed(_YOUNG, month)
    green = _mixed(look.green, look.fresh, young)
    if look.autumn is None:
        return replace(look, green=green)
    turned = _passed(_TURNING, month)
    return replace(
        look,
        green=_mixed(green, look.autumn, turned),
        fresh=_mixed(look.fresh, look.autumn, turned),
    )


def _mixed(one: Color, other: Color, share: float) -> Color:
    mixed = (1.0 - share) * np.array(one) + share * np.array(other)
    red, green, blue = mixed.tolist()
    return red, green, blue


def _passed(phase: tuple[float, float], month: float) -> float:
    """How far a phase is over, 0 to 1."""
    return float(np.interp(month, phase, (0.0, 1.0)))
