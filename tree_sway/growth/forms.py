# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Habit of each species: bole, limbs, twigs, outline.

Forms are those of trees in the open, drawn from descriptions in field guides (Mitchell
1974; Roloff 2001); lengths are over the height of the tree, angles in [rad] above the horizon.

"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
import math
from typing import TypeVar

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.growth.crown_allometry import CrownChange
from tree_sway.tables import table_beside

_HIGHEST_BASE, _LARGEST_HALF_WIDTH = 0.8, 0.7
"""Bounds of a crown that follows the diameter of its stem, over the height of the tree."""


@dataclass(frozen=True)
class Outline:
    """
    Surface of revolution that a crown fills.

    Parameters
    ----------
    base
        Height of the lowest leaves.
    half_width
        Largest radius.
    widest
        Relative height of the largest radius, from 0 at the base to 1 at the top.
    below, above
        Exponents of the outline below and above it: 1 is a cone, 2 an ellipsoid, more a box.

    """

    base: float
    half_width: float
    widest: float
    below: float
    above: float

    def radius(self, height: Floats) -> Floats:
        """Radius at heights, 0 outside."""
        u = (height - self.base) / (1.0 - self.base)
        low = (self.widest - u) / self.widest
        high = (u - self.widest) / (1.0 - self.widest)
        away = np.clip(np.maximum(low, high), 0.0, 1.0)
        power = np.where(u < self.widest, self.below, self.above)
        return np.asarray(self.half_width * (1.0 - away**power) ** (1.0 / power))

    def changed(self, change: CrownChange) -> Outline:
        """Return the outline of a crown that is wider and begins lower, or the reverse."""
        logit = math.log(self.base / (1.0 - self.base)) + change.bare
        base = min(1.0 / (1.0 + math.exp(-logit)), max(_HIGHEST_BASE, self.base))
        widest = max(_LARGEST_HALF_WIDTH, self.half_width)
        half_width = min(self.half_width * change.width, widest)
        return replace(self, base=base, half_width=half_width)

    def room(self, origin: Floats, way: Floats) -> float:
        """Distance from a point along a unit vector to the crown's surface; 0 from the outside."""
        steps = np.linspace(0.0, 1.0, 101)
        x, y, z = (origin + steps[:, None] * way).T
        is_out = np.hypot(x, y) > self.radius(z)
        return float(steps[np.argmax(is_out)])


@dataclass(frozen=True)
class BroadleafForm:
    """
    Habit of a broadleaf.

    Parameters
    ----------
    outline
        Outline of the crown.
    bole
        Height of the lowest limb.
    trunk
        Length of the trunk, which ends in the crown.
    n_limbs
        Limbs on the trunk.
    rise
        Elevation of the lowest and of the highest limb where they start.
    turn
        Change of the elevation of the lowest and of the highest to their tips.
    wander
        Standard deviation of a limb's heading from segment to segment.
    is_opposite
        True for limbs and branches in pairs, False for a spiral.
    n_branches
        Branches of a limb.
    spread
        Angle between a branch and its limb.
    branch_turn
        Change of the elevation of a branch to its tip.
    lift
        Bend of twigs upwards (positive) or downwards (negative); 1 is half-way.
    twig
        Length of the twigs.
    exponent
        Exponent of the pipe model; less makes branches thinner beside their stem. Trees have 1.8
        to 2.3 (Eloy 2011, Physical Review Letters 107, 258101).
    taper
        Exponent of the distance from the top in a further taper of the trunk, as of a conifer's
        stem; small where the trunk reaches the top.
    slenderness
        Height over diameter.

    """

    outline: Outline
    bole: float
    trunk: float
    n_limbs: int
    rise: tuple[float, float]
    turn: tuple[float, float]
    wander: float
    is_opposite: bool
    n_branches: int
    spread: float
    branch_turn: float
    lift: float
    twig: float
    exponent: float
    taper: float
    slenderness: float


@dataclass(frozen=True)
class ConiferForm:
    """
    Habit of a conifer.

    Parameters
    ----------
    outline
        Outline of the crown.
    n_whorls, whorl
        Whorls of branches, and branches in each.
    rise
        Elevation of a branch of the lowest and of the highest whorl where they start.
    turn
        Change of that elevation to the tip.
    wander
        Standard deviation of a branch's heading from segment to segment.
    lift
        Bend of twigs upwards (positive) or downwards (negative); 1 is half-way.
    twig
        Length of the twigs over that of their branch.
    exponent
        Exponent of the pipe model; less makes branches thinner beside their stem.

    """

    outline: Outline
    n_whorls: int
    whorl: int
    rise: tuple[float, float]
    turn: float
    wander: float
    lift: float
    twig: float
    exponent: float


_Form = TypeVar('_Form', BroadleafForm, ConiferForm)


def _forms(name: str, form: type[_Form]) -> dict[str, _Form]:
    rows = table_beside(__file__, name)
    found = {}
    for row in rows:
        outline = Outline(**{each.name: row[each.name] for each in fields(Outline)})
        own = {each.name: row[each.name] for each in fields(form) if each.name in row}
        found[row['key']] = form(outline, **own)
    return found


_BROADLEAVES = _forms('broadleaf_forms.csv', BroadleafForm)
_CONIFERS = _forms('conifer_forms.csv', ConiferForm)


def broadleaf_form(species: str) -> BroadleafForm:
    """Habit of a species grown as a broadleaf; that of an average one if it is unknown."""
    return _BROADLEAVES.get(species, _BROADLEAVES['any'])


def conifer_form(species: str) -> ConiferForm:
    """Habit of a species grown as a conifer; that of an average one if it is unknown."""
    return _CONIFERS.get(species, _CONIFERS['any'])


def changed_form(form: _Form, change: CrownChange) -> _Form:
    """Return a habit whose crown is changed; the lowest limb moves with the base of the crown."""
    outline = form.outline.changed(change)
    if not isinstance(form, BroadleafForm):
        return replace(form, outline=outline)
    bole = form.bole + outline.base - form.outline.base
    return replace(form, outline=outline, bole=min(bole, max(0.8 * form.trunk, form.bole)))
