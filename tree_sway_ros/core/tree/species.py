# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
What a tree is made of: wood, damping, drag and leaves of each species, with the sources.

A new species is one entry of the table here; every part of the program reads it from it.

Modulus and density are of green wood: ForestGALES species tables, the BIOMASS wood density table
and the field table of Jackson et al. (2019). Drag in leaf is C U^-N between 4 and 20 m/s: Mayhead
(1973) for conifers, Vollsinger et al. (2005) for broadleaves. Ash, sycamore, walnut, Ficus and a
broadleaf of no known species take the mean of the three measured broadleaves, Goldcrest takes
spruce's. Entries marked as estimates have no measurement behind them. Where leaves come from
stands in `leaf_traits`.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
import math
from typing import Any

from tree_sway_ros.core.tree.leaf_traits import BROAD_LEAVES, LeafTraits, NEEDLES
from tree_sway_ros.errors import nearest, SpeciesError


@dataclass(frozen=True)
class Species:
    """
    Wood, damping, drag, leaves and habit of a species.

    Parameters
    ----------
    key, title
        Name in the table and name for people.
    modulus
        Young's modulus of green wood in [Pa].
    density
        Density of green wood in [kg/m^3].
    damping_bare, damping_in_leaf
        Damping ratio without and with leaves in [-]; air drag on moving branches comes on top.
    drag_coefficient
        C of the drag law Cd = C U^-N in leaf, U in [m/s].
    drag_exponent
        N of the drag law in [-]: how much the crown streamlines.
    bare_drag_coefficient
        Cd without leaves, at every speed: that of a cylinder of a branch's size in wind, 0.82 to
        1.2.
    shear_ratio
        Shear modulus over Young's modulus in [-]; that of an isotropic rod. Along the grain, wood
        is nearer to 1/14 (Forest Products Laboratory, Wood Handbook, 2010), which softens the
        twist of stems alone.
    root_stiffness
        Stiffness of the roots against tilting of the stem in [N m/rad]; infinite where they do not
        give way. Belongs to one tree; `typical_root_stiffness` tells that of a size.
    leaves
        Its leaves; evergreen ones are there unless a simulator is told otherwise.
    bark
        Colour of its bark in pictures, red, green and blue from 0 to 1.
    habit
        How `grow` shapes it: ``conifer``, ``broadleaf`` or ``pot``.
    is_estimate
        True where modulus or density is a guess to be calibrated.

    """

    key: str
    title: str
    modulus: float
    density: float
    damping_bare: float = 0.04
    damping_in_leaf: float = 0.10
    drag_coefficient: float = 1.2
    drag_exponent: float = 0.0
    bare_drag_coefficient: float = 1.2
    shear_ratio: float = 1.0 / 14.0
    root_stiffness: float = math.inf
    leaves: LeafTraits = BROAD_LEAVES
    bark: tuple[float, float, float] = (0.36, 0.28, 0.22)
    habit: str = 'broadleaf'
    is_estimate: bool = False

    def damping(self, in_leaf: bool) -> float:
        """Return the damping ratio with or without leaves in [-]."""
        return self.damping_in_leaf if in_leaf else self.damping_bare

    def drag_law(self, in_leaf: bool) -> tuple[float, float]:
        """Return C and N of ``Cd = C U^-N``; bare branches do not streamline."""
        if in_leaf:
            return self.drag_coefficient, self.drag_exponent
        return self.bare_drag_coefficient, 0.0


def _needles(*green: float) -> LeafTraits:
    """Average needles of a colour of their own."""
    return replace(NEEDLES, green=green)  # type: ignore[arg-type]


def _species(
    key: str, title: str, modulus: float, density: float, drag: tuple[float, float], **told: Any
) -> Species:
    """One row of the table; the drag is C and N of the law in leaf."""
    told |= {'drag_coefficient': drag[0], 'drag_exponent': drag[1]}
    return Species(key, title, modulus, density, **told)


_conifer = partial(_species, habit='conifer')
_estimate = partial(_species, is_estimate=True)
_BROADLEAF, _SPRUCE = (2.345, 0.877), (2.35, 0.51)

_TABLE = {s.key: s for s in (
    _estimate('benjamina', 'Ficus benjamina', 8.3e9, 950.0, _BROADLEAF, habit='pot',
              leaves=LeafTraits(0.05, 4400.0, 0.20, 5.0, True, green=(0.22, 0.45, 0.16)),
              bark=(0.52, 0.48, 0.42)),
    _estimate('goldcrest', "Cupressus macrocarpa 'Goldcrest'", 6.0e9, 950.0, _SPRUCE, habit='pot',
              leaves=LeafTraits(0.03, 1800.0, 0.45, 7.0, True, True, green=(0.63, 0.70, 0.22)),
              bark=(0.46, 0.32, 0.24)),
    _estimate('broadleaf', 'a broadleaf of no known species', 9.0e9, 900.0, _BROADLEAF),
    _conifer('spruce', 'Norway spruce', 6.3e9, 850.0, _SPRUCE,
             leaves=_needles(0.20, 0.36, 0.22), bark=(0.42, 0.29, 0.22)),
    _conifer('sitka', 'Sitka spruce', 5.9e9, 850.0, _SPRUCE,
             leaves=_needles(0.26, 0.40, 0.30), bark=(0.42, 0.37, 0.36)),
    _conifer('pine', 'Scots pine', 7.3e9, 850.0, (3.07, 0.75), bark=(0.66, 0.40, 0.24),
             leaves=LeafTraits(0.12, 1000.0, 0.55, 5.0, True, True, green=(0.28, 0.42, 0.28))),
    _conifer('douglas_fir', 'Douglas-fir', 8.3e9, 850.0, (2.40, 0.70),
             leaves=_needles(0.22, 0.38, 0.20), bark=(0.38, 0.29, 0.24)),
    _species('birch', 'birch', 9.9e9, 900.0, (1.9627, 0.881), bark=(0.86, 0.85, 0.81),
             leaves=LeafTraits(0.045, 4000.0, 0.16, 5.0, green=(0.40, 0.57, 0.22))),
    _species('oak', 'oak', 9.4e9, 1010.0, (2.6575, 0.846), bark=(0.36, 0.31, 0.26),
             leaves=LeafTraits(0.09, 1900.0, 0.20, 3.5)),
    _species('beech', 'beech', 9.8e9, 1158.0, (2.4141, 0.904), bark=(0.55, 0.56, 0.54),
             leaves=LeafTraits(0.065, 3000.0, 0.17, 4.5, green=(0.25, 0.48, 0.18))),
    _species('ash', 'ash', 9.5e9, 801.0, _BROADLEAF, bark=(0.52, 0.50, 0.44),
             leaves=LeafTraits(0.06, 2700.0, 0.18, 4.5, green=(0.34, 0.55, 0.24))),
    _species('sycamore', 'sycamore', 8.4e9, 721.0, _BROADLEAF, bark=(0.50, 0.45, 0.41),
             leaves=LeafTraits(0.13, 2600.0, 0.18, 3.0, green=(0.27, 0.45, 0.17))),
    _species('walnut', 'walnut', 11.3e9, 805.0, _BROADLEAF, bark=(0.46, 0.43, 0.40),
             leaves=LeafTraits(0.10, 2500.0, 0.21, 3.0, green=(0.36, 0.53, 0.20))),
)}  # fmt: skip


def species_named(key: str) -> Species:
    """
    Look a species up.

    Raises
    ------
    SpeciesError
        If no species has that key; the error lists those that exist.

    """
    if not isinstance(key, str):
        what = f'a {type(key).__name__}, where the key of a species is asked for'
        raise SpeciesError(what, cure="give its key, as 'oak'")
    try:
        return _TABLE[key]
    except KeyError:
        cure = f'{nearest(key, _TABLE)} use one of: {", ".join(sorted(_TABLE))}'.lstrip()
        raise SpeciesError(f"unknown species '{key}'", cure=cure) from None


def species_keys() -> tuple[str, ...]:
    """Keys of every species in the table."""
    return tuple(_TABLE)


def bark_color(key: str) -> tuple[float, float, float]:
    """Colour of a species' bark; that of an average tree if the table does not have it."""
    return _TABLE[key].bark if key in _TABLE else Species.bark


def typical_root_stiffness(stem_mass: float) -> float:
    """
    Stiffness against tilting in [N m/rad] of the roots of a tree with a stem of so many [kg].

    Conifers go over at a moment in proportion to the mass of their stem (winching tests on near
    2,000 trees: Nicoll et al. 2006), of 77 to 146 N m per kg in four species (Byrne 2005), of
    which 120 is taken. They tilt by a quarter of a degree at 40 % of that (280 trees: Detter, Rust
    & Krisans 2023, Forests 14, 533). Soils differ by a factor of two. That broadleaves are like
    conifers is assumed.
    """
    return 0.4 * 120.0 * stem_mass / math.radians(0.25)


def leaf_traits(key: str) -> LeafTraits:
    """Leaves of a species; those of an average broadleaf if the table does not have it."""
    return _TABLE[key].leaves if key in _TABLE else BROAD_LEAVES
