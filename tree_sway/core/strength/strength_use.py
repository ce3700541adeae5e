# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The largest share of its strength that a tree has used.

Wood breaks where its stress, Young's modulus times strain, reaches its modulus of rupture. Small
clear specimens scatter by 16 % (Forest Products Laboratory, Wood Handbook, 2010, table 5-6), and
knots reduce that of a stem by 15 % (Gardiner et al. 2000, Ecological Modelling 129, 1-23). Roots
fail at a moment of 77 to 146 N m for each kg of the stem, by species and soil (Byrne 2005;
winching tests of near 2,000 conifers: Nicoll et al. 2006).

Bands also have the spread of the load: `LOAD_SPREADS`, and `LEAF_SPREAD` in leaf.

Rot, wounds and forks, a wet or shallow soil, the stress of growth and of the tree's own weight,
fatigue, and sheltering by neighbours are left out. It is no verdict on a tree's safety.
"""

from __future__ import annotations

from dataclasses import dataclass
import math
from typing import Any

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.setup.reductions import TreeReductions
from tree_sway.core.strength.wood_strain import WoodStrain

WOOD_BAND = (0.85 * (1.0 - 0.16), 1.0 + 0.16)
"""Modulus of rupture of a tree's wood over that of its species' mean [-]."""

LOAD_SPREADS = {'drag': 0.25, 'wind at the crown': 0.3}
"""
Log-deviations of what loads a tree: drag coefficients of crowns of one species (Mayhead 1973;
Vollsinger et al. 2005) and the wind at a crown by a profile.

"""

LEAF_SPREAD = 0.35
"""Log-deviation of the leaf area of a stem: a factor of two either way (`LeafTraits`)."""

ROOT_MOMENT, ROOT_BAND = 110.0, (77.0, 146.0)
"""Strength of roots as a moment per mass of the stem, mean and band in [N m/kg]."""


@dataclass(frozen=True)
class StrengthUse:
    """
    Largest used shares of the strength of a tree.

    Parameters
    ----------
    wood
        Largest share of the modulus of rupture [-], with its lower and upper bound by `WOOD_BAND`
        and by the spreads of the load, (3,).
    branch, height
        Branch with that share, and its height above the base of the tree in [m].
    roots
        Largest share of the strength of the roots [-], with its lower and upper bound, (3,); nan
        in a pot.
    in_leaf
        Whether the tree bore leaves.
    base_moment
        Largest bending moment at the base of the stem in [N m].

    """

    wood: Floats
    branch: str
    height: float
    roots: Floats
    in_leaf: bool = False
    base_moment: float = math.nan

    def plain(self) -> dict[str, Any]:
        """Return the fields as plain numbers, for JSON; ``roots`` is None in a pot."""
        roots = self.roots.tolist() if np.isfinite(self.roots).all() else None
        return {**vars(self), 'wood': self.wood.tolist(), 'roots': roots}

    def __str__(self) -> str:
        """Return both with their bands as one line, and whether the tree is in leaf."""
        wood, roots = (
            '{:.3g} % ({:.3g} to {:.3g} %)'.format(*100.0 * share)
            for share in (self.wood, self.roots)
        )
        roots = roots if np.isfinite(self.roots).all() else 'unknown in a pot'
        place = f'{self.branch}, {self.height:.2g} m up'
        season = 'in leaf' if self.in_leaf else 'bare'
        return f'strength used: wood {wood} in {place}; roots {roots}; {season}'


class StrengthGauge:
    """Largest strain of each segment and largest base moment of a swaying tree."""

    def __init__(self, reductions: TreeReductions) -> None:
        """Begin at rest."""
        self._reductions = reductions
        self._strain = WoodStrain(reductions)
        self._largest, self._moment = np.zeros(len(self._strain.branch)), 0.0

    def read(self, rotations: Floats, base_moment: Floats) -> Floats:
        """
        Add one step.

        Parameters
        ----------
        rotations
            Key rotations in [rad], (N,).
        base_moment
            Moment at the base of the stem in [N m], (3,).

        Returns
        -------
        Floats
            Largest strain along each branch [-], (b,).

        """
        strain = self._strain.of(rotations)
        np.maximum(self._largest, strain, out=self._largest)
        self._moment = max(self._moment, float(np.linalg.norm(base_moment)))
        of_branch = np.zeros(self._reductions.tree.n_branches)
        np.maximum.at(of_branch, self._strain.branch, strain)
        return of_branch

    def use(self) -> StrengthUse:
        """Return the used shares since the beginning."""
        tree, species = self._reductions.tree, self._reductions.species
        at = int(np.argmax(self._largest))
        stem_mass = species.density * float(tree.volume[tree.segments_of(0)].sum())
        capacity = np.nan if species.habit == 'pot' else ROOT_MOMENT * stem_mass
        in_leaf = bool(self._reductions.settings.in_leaf)
        wood = species.modulus * self._largest[at] / species.rupture
        roots = self._moment / capacity
        weakest, strongest = ROOT_BAND[0] / ROOT_MOMENT, ROOT_BAND[1] / ROOT_MOMENT
        return StrengthUse(
            wood * _band(WOOD_BAND, in_leaf),
            tree.branch_names[int(self._strain.branch[at])],
            float(self._strain.height[at]),
            roots * _band((weakest, strongest), in_leaf),
            in_leaf,
            self._moment,
        )


def _band(strength: tuple[float, float], in_leaf: bool) -> Floats:
    """
    Return 1 and the bounds of a used share over it, (3,).

    Strength has a smallest and a largest value over its mean; its logarithm and those of what
    loads the tree are independent.
    """
    loads = [*LOAD_SPREADS.values(), *([LEAF_SPREAD] if in_leaf else [])]
    load = math.hypot(*loads)
    weak, strong = (math.hypot(load, math.log(each)) for each in strength)
    return np.array([1.0, math.exp(-strong), math.exp(weak)])
