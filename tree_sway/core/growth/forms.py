# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
What distinguishes a tree of one species from another at a distance: bole, limbs, twigs, outline.

Forms are those of trees in the open, drawn from descriptions in field guides (Mitchell
1974; Roloff 2001); lengths are over the height of the tree, angles in [rad] above the horizon.

"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tree_sway.core.arrays import Floats


@dataclass(frozen=True)
class Outline:
    """
    Surface of revolution that a crown fills.

    Parameters
    ----------
    base
        Height of the lowest leaves.
    half_width
        Radius where it is widest.
    widest
        Where it is widest, from 0 at the base to 1 at the top.
    below, above
        Exponents of the outline under and over that: 1 is a cone, 2 an ellipsoid, more a box.

    """

    base: float
    half_width: float
    widest: float = 0.4
    below: float = 2.0
    above: float = 2.0

    def radius(self, height: Floats) -> Floats:
        """Radius at heights, 0 outside."""
        u = (height - self.base) / (1.0 - self.base)
        low, high = (self.widest - u) / self.widest, (u - self.widest) / (1.0 - self.widest)
        away = np.clip(np.maximum(low, high), 0.0, 1.0)
        power = np.where(u < self.widest, self.below, self.above)
        return np.asarray(self.half_width * (1.0 - away**power) ** (1.0 / power))

    def reach(self, origin: Floats, way: Floats) -> float:
        """Distance from a point to where a unit vector leaves the crown; 0 from the outside."""
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
        Of the crown.
    bole
        Height of the lowest limb.
    trunk
        Length of the trunk, which loses itself in the crown.
    n_limbs
        Limbs on the trunk.
    rise
        Elevation of the lowest and of the highest limb where they start.
    turn
        By how much the elevation of the lowest and of the highest changes to their tips.
    wander
        Standard deviation of a limb's heading from segment to segment.
    is_opposite
        Whether limbs and branches come in pairs, or one by one in a spiral.
    n_branches
        Branches of a limb.
    spread
        Angle between a branch and its limb.
    branch_turn
        By how much the elevation of a branch changes to its tip.
    lift
        How much twigs turn up (positive) or hang (negative); 1 is half-way.
    twig
        Length of the twigs.
    exponent
        Of the pipe model; less makes branches thinner beside their stem. Trees have 1.8 to 2.3
        (Eloy 2011, Physical Review Letters 107, 258101).
    taper
        Power of the distance from the top that the trunk tapers with on top of that; as a
        conifer's stem, and hardly where the trunk goes to the very top.
    slenderness
        Height over diameter.

    """

    outline: Outline
    bole: float = 0.25
    trunk: float = 0.7
    n_limbs: int = 15
    rise: tuple[float, float] = (0.2, 0.9)
    turn: tuple[float, float] = (0.3, 0.3)
    wander: float = 0.09
    is_opposite: bool = False
    n_branches: int = 6
    spread: float = 0.75
    branch_turn: float = 0.2
    lift: float = 0.2
    twig: float = 0.045
    exponent: float = 2.0
    taper: float = 0.7
    slenderness: float = 45.0


@dataclass(frozen=True)
class ConiferForm:
    """
    Habit of a conifer.

    Parameters
    ----------
    outline
        Of the crown.
    n_whorls, whorl
        Whorls of branches, and branches in each.
    rise
        Elevation of a branch of the lowest and of the highest whorl where they start.
    turn
        By how much it changes to the tip.
    wander
        Standard deviation of a branch's heading from segment to segment.
    lift
        How much twigs turn up (positive) or hang (negative); 1 is half-way.
    twig
        Length of the twigs over that of their branch.
    exponent
        Of the pipe model; less makes branches thinner beside their stem.

    """

    outline: Outline
    n_whorls: int = 16
    whorl: int = 5
    rise: tuple[float, float] = (-0.15, 0.8)
    turn: float = 0.35
    wander: float = 0.05
    lift: float = 0.0
    twig: float = 0.3
    exponent: float = 2.2


_BROADLEAVES = {
    # Short stout bole, heavy crooked limbs far out, as wide as high.
    'oak': BroadleafForm(
        Outline(0.16, 0.45, 0.42, 2.2, 2.3), 0.2, 0.62, 13, (0.1, 1.0), (0.25, 0.2), 0.2,
        spread=0.95, branch_turn=0.15, lift=0.3, slenderness=42.0,
    ),
    # White stem to the very top, slender limbs that rise steeply and hang at their ends.
    'birch': BroadleafForm(
        Outline(0.14, 0.24, 0.36, 1.6, 1.5), 0.2, 0.96, 20, (0.75, 1.15), (-0.9, -0.35), 0.05,
        spread=0.6, branch_turn=-1.2, lift=-2.0, twig=0.07, taper=0.2, slenderness=58.0,
    ),
    # Smooth straight stem, many limbs, dense dome down low.
    'beech': BroadleafForm(
        Outline(0.08, 0.37, 0.42, 2.6, 2.4), 0.14, 0.84, 18, (0.3, 1.1), (0.1, 0.15), 0.06,
        spread=0.7, branch_turn=-0.25, lift=-0.1,
    ),
    # Long bole, few open limbs in pairs; branches bow down and turn up at their ends.
    'ash': BroadleafForm(
        Outline(0.2, 0.34, 0.52, 2.0, 2.0), 0.32, 0.8, 12, (0.5, 1.0), (0.1, 0.2), 0.06, True,
        spread=0.95, branch_turn=0.9, lift=0.9, twig=0.06, slenderness=52.0,
    ),
    # Broad full dome on a stout bole, limbs in pairs.
    'sycamore': BroadleafForm(
        Outline(0.15, 0.41, 0.46, 3.0, 3.0), 0.2, 0.72, 16, (0.3, 1.1), (0.3, 0.1), 0.08, True,
        spread=0.85, branch_turn=0.3, lift=0.4, exponent=1.98, taper=1.0,
    ),
    # Short bole that parts into few wide limbs; round open crown of coarse twigs.
    'walnut': BroadleafForm(
        Outline(0.2, 0.43, 0.5, 2.0, 2.2), 0.24, 0.46, 10, (0.35, 1.05), (0.25, 0.2), 0.12,
        n_branches=7, spread=0.9, branch_turn=0.3, lift=0.5, twig=0.065,
    ),
    # Dense round crown on a short bole, limbs in pairs that rise steeply.
    'maple': BroadleafForm(
        Outline(0.16, 0.36, 0.48, 2.6, 2.6), 0.2, 0.66, 16, (0.6, 1.2), (0.15, 0.1), 0.06, True,
        spread=0.65, branch_turn=0.2, lift=0.3,
    ),
    # Tall dome, widest low; limbs arch over and sweep down with upturned ends.
    'lime': BroadleafForm(
        Outline(0.07, 0.30, 0.3, 2.4, 1.9), 0.12, 0.9, 20, (0.7, 1.1), (-0.9, -0.1), 0.05,
        spread=0.7, branch_turn=-0.3, lift=-0.3, taper=0.4, slenderness=48.0,
    ),
    # Short bole, limbs that rise and arch; branches and long twigs hang like curtains.
    'willow': BroadleafForm(
        Outline(0.06, 0.42, 0.5, 3.0, 2.4), 0.22, 0.6, 13, (0.8, 1.2), (-1.0, -0.5), 0.1,
        n_branches=7, spread=0.8, branch_turn=-2.4, lift=-3.5, twig=0.12, slenderness=38.0,
    ),
    # Stem to the very top, many steep limbs close to it: a tall narrow column.
    'poplar': BroadleafForm(
        Outline(0.06, 0.17, 0.4, 2.2, 1.5), 0.1, 0.96, 24, (1.0, 1.3), (0.1, 0.05), 0.05,
        spread=0.45, branch_turn=0.4, lift=0.6, taper=0.2, slenderness=55.0,
    ),
    # Straight stem to the top, level limbs that shorten upwards: a cone among broadleaves.
    'alder': BroadleafForm(
        Outline(0.1, 0.24, 0.22, 1.7, 1.15), 0.14, 0.97, 22, (0.2, 0.9), (0.1, 0.1), 0.07,
        spread=0.8, branch_turn=0.1, lift=0.1, taper=0.2, slenderness=52.0,
    ),
    # Vase: limbs part low and spread upwards, widest near a flat top.
    'cherry': BroadleafForm(
        Outline(0.16, 0.40, 0.72, 1.3, 3.0), 0.18, 0.5, 11, (0.6, 1.1), (0.05, 0.1), 0.05,
        spread=0.5, branch_turn=0.1, lift=0.4,
    ),
    # Long clean bole, huge open dome on few far-reaching limbs.
    'plane': BroadleafForm(
        Outline(0.26, 0.44, 0.46, 2.4, 2.4), 0.32, 0.68, 11, (0.3, 1.0), (0.35, 0.2), 0.14,
        n_branches=7, spread=0.85, branch_turn=-0.4, lift=-0.4, twig=0.06, slenderness=44.0,
    ),
    # Bare for half its height, then few steep limbs with tufts of hanging leaves at their ends.
    'eucalyptus': BroadleafForm(
        Outline(0.42, 0.27, 0.62, 1.5, 2.6), 0.46, 0.78, 9, (0.8, 1.2), (-0.2, 0.0), 0.12,
        n_branches=5, spread=0.6, branch_turn=-0.5, lift=-1.2, twig=0.07, slenderness=60.0,
    ),
}  # fmt: skip

_CONIFERS = {
    # Pointed cone from near the ground; branches sag and turn up, twigs hang like a comb.
    'spruce': ConiferForm(
        Outline(0.16, 0.18, 0.25, 1.25, 1.1), 20, 5, (-0.35, 0.75), 0.5, 0.05, -1.2, 0.3, 2.7
    ),
    # Broad stiff cone, branches level and straight.
    'sitka': ConiferForm(
        Outline(0.24, 0.21, 0.34, 1.2, 1.0), 17, 5, (0.05, 0.65), 0.05, 0.02, 0.1, 0.3, 2.3
    ),
    # Long bare bole, few crooked branches that turn up, flat open crown.
    'pine': ConiferForm(
        Outline(0.5, 0.22, 0.5, 2.0, 2.8), 11, 4, (-0.1, 0.55), 0.45, 0.16, 0.9, 0.35, 1.95
    ),
    # Full cone, level branches turned up at their ends.
    'douglas_fir': ConiferForm(
        Outline(0.38, 0.19, 0.38, 1.3, 1.25), 15, 5, (-0.1, 0.8), 0.4, 0.06, -0.4, 0.3, 2.3
    ),
    # Narrow spire of level, stiff, flat branches in dense whorls.
    'fir': ConiferForm(
        Outline(0.2, 0.14, 0.3, 1.6, 1.3), 22, 5, (0.0, 0.5), 0.1, 0.02, 0.2, 0.4, 3.0
    ),
    # Light open cone; branches droop and sweep up, twigs hang.
    'larch': ConiferForm(
        Outline(0.25, 0.2, 0.3, 1.3, 1.2), 14, 4, (-0.1, 0.7), 0.6, 0.1, -1.6, 0.4, 2.8
    ),
}  # fmt: skip

_ANY_BROADLEAF = BroadleafForm(Outline(0.15, 0.39, 0.5))
_ANY_CONIFER = ConiferForm(Outline(0.36, 0.17, 0.3, 1.6, 1.2))


def broadleaf_form(species: str) -> BroadleafForm:
    """Habit of a species grown as a broadleaf; that of an average one if it has none."""
    return _BROADLEAVES.get(species, _ANY_BROADLEAF)


def conifer_form(species: str) -> ConiferForm:
    """Habit of a species grown as a conifer; that of an average one if it has none."""
    return _CONIFERS.get(species, _ANY_CONIFER)
