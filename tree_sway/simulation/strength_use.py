# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The largest share of its strength that a tree has used.

Wood breaks where its stress, Young's modulus times strain, reaches its modulus of rupture. A tree
falls if its roots fail, or if its stem breaks in the lower half of its height; limbs, and the thin
leader of a broad crown, break before.

Roots hold as much as the stem at its base, but in a stand (the profile of a canopy), where they
fail at `ROOT_MOMENT` for each kg of the stem. Of 24 large shade trees, maples of the open, that
were pulled down none came out of the ground: 11 broke in the stem and 13 at a fork (Kane &
Clouston 2008, Arboriculture & Urban Forestry 34, 101-109), so theirs held more than that. And
35 % of the reported failures of urban trees are of roots (International Tree Failure Database
2013, quoted in Arboriculture & Urban Forestry 40, 230-236), so it is not much more. The
stem of a shade tree is a small part of its wood: the rule of stands would not know the limbs.

Bands hold the strength and the load (`strength_band`).

Rot, wounds and forks, a wet or shallow soil, the stress of growth and of the tree's own weight,
fatigue, and sheltering by neighbours are left out. It is no verdict on a tree's safety.
"""

from __future__ import annotations

from dataclasses import dataclass
import math
from typing import Any

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.setup import TreeReductions
from tree_sway.core.species import ROOT_MOMENT
from tree_sway.simulation.strength_band import load_band, root_band, wood_band
from tree_sway.simulation.wood_strain import WoodStrain


@dataclass(frozen=True)
class StrengthUse:
    """
    Largest used shares of the strength of a tree.

    Parameters
    ----------
    wood
        Largest share of the modulus of rupture [-], with its lower and upper bound, (3,).
    branch, height
        Branch with that share, and its height above the base of the tree in [m].
    roots
        Largest share of the strength of the roots [-], with its lower and upper bound, (3,); nan
        in a pot.
    in_leaf
        Whether the tree bore leaves.
    base_moment
        Largest bending moment at the base of the stem in [N m].
    stem
        Largest share of the modulus of rupture in the lower half of the stem [-].

    """

    wood: Floats
    branch: str
    height: float
    roots: Floats
    in_leaf: bool = False
    base_moment: float = math.nan
    stem: float = math.nan

    @property
    def moment_band(self) -> tuple[float, float]:
        """Bounds of the bending moment at the base in [N m], by the spreads of the load."""
        _, low, high = (self.base_moment * load_band(in_leaf=self.in_leaf)).tolist()
        return low, high

    def plain(self) -> dict[str, Any]:
        """Return the fields as plain numbers, for JSON; ``roots`` is None in a pot."""
        roots = self.roots.tolist() if np.isfinite(self.roots).all() else None
        return {**vars(self), 'wood': self.wood.tolist(), 'roots': roots}

    @property
    def season(self) -> str:
        """Whether the tree was in leaf or bare, in words."""
        return 'in leaf' if self.in_leaf else 'bare'

    def __str__(self) -> str:
        """Return both with their bands as one line, and whether the tree is in leaf."""
        wood, roots = (
            '{:.3g} % ({:.3g} to {:.3g} %)'.format(*100.0 * share)
            for share in (self.wood, self.roots)
        )
        roots = roots if np.isfinite(self.roots).all() else 'unknown in a pot'
        place = f'{self.branch}, {self.height:.2g} m up'
        return f'strength used: wood {wood} in {place}; roots {roots}; {self.season}'


class StrengthGauge:
    """Largest strain of each segment, or of some, and largest base moment of a swaying tree."""

    def __init__(self, reductions: TreeReductions, n_branches: int | None = None) -> None:
        """Begin at rest; ``n_branches`` as for `WoodStrain`."""
        self._reductions = reductions
        self._strain = WoodStrain(reductions, n_branches)
        self._largest = np.zeros(len(self._strain.branch))
        self._moment = 0.0

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
        tree = self._reductions.tree
        species = self._reductions.species
        at = int(np.argmax(self._largest))
        if species.habit == 'pot':
            capacity = math.nan
        elif self._reductions.settings.profile.kind == 'canopy':
            stem_mass = species.density * float(tree.volume[tree.segments_of(0)].sum())
            capacity = ROOT_MOMENT * stem_mass
        else:
            capacity = species.rupture * np.pi / 32.0 * float(tree.base_diameter[0]) ** 3
        is_low = (self._strain.branch == 0) & (self._strain.height <= 0.5 * tree.height)
        in_leaf = bool(self._reductions.settings.in_leaf)
        share = species.modulus / species.rupture * self._largest
        roots = self._moment / capacity
        return StrengthUse(
            share[at] * wood_band(in_leaf=in_leaf),
            tree.branch_names[int(self._strain.branch[at])],
            float(self._strain.height[at]),
            roots * root_band(in_leaf=in_leaf),
            in_leaf,
            self._moment,
            float(share[is_low].max()),
        )
