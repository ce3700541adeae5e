# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Wood, damping, drag and leaves of a species."""

from __future__ import annotations

from dataclasses import dataclass, field
import math

from tree_sway.core.species.foliage_traits import LeafTraits
from tree_sway.core.species.look import Look

WOOD_SPREAD = 0.22
"""
Log-deviation of Young's modulus of clear wood of one species: 22 % (Forest Products Laboratory,
Wood Handbook, 2010, table 5-6).
"""


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
        Damping ratio without and with leaves in [-]; damping by drag is added. Those given here
        are of broadleaves: wood and roots damp by less than 0.05, all else is drag and contact of
        crowns (review by Moore & Maguire 2004, Trees 18, 195-203). With the drag of still air,
        which is computed, it is 1.5 +- 0.3 times that of the bare tree, as of Norway maples
        (Netsvetov & Nikulina 2010, Dendrobiology 64, 37-42).
    drag_coefficient
        C of the drag law Cd = C U^-N in leaf, U in [m/s].
    drag_exponent
        N of the drag law in [-], by which the crown streamlines; -N is the Vogel exponent.
    bare_drag_coefficient
        Cd without leaves, at every speed: that of a cylinder of a branch's size in wind, 0.82 to
        1.2.
    shear_ratio
        Shear modulus over Young's modulus in [-]. Wood has some 1/14 along the grain (Forest
        Products Laboratory, Wood Handbook, 2010); an isotropic rod would have 1/2.6. It sets the
        twist of stems only.
    root_stiffness
        Stiffness of the roots against tilting of the stem in [N m/rad]; infinite for rigid roots.
        It is that of one tree; `typical_root_stiffness` gives that of a size.
    leaves
        Leaves of the species; evergreen ones are present by default.
    rupture
        Modulus of rupture of green wood in [Pa]: small clear specimens in bending.
    twig_diameter
        Diameter of the last twigs in [m], to which scans are corrected.
    look
        Colours, bark and sprays of leaves in pictures.
    habit
        Habit by which `grow` makes the tree: ``conifer``, ``broadleaf`` or ``pot``.
    is_estimate
        True where modulus or density is a guess to be calibrated.

    """

    key: str
    title: str
    modulus: float
    density: float
    damping_bare: float = 0.04
    damping_in_leaf: float = 0.05
    drag_coefficient: float = 1.2
    drag_exponent: float = 0.0
    bare_drag_coefficient: float = 1.2
    shear_ratio: float = 1.0 / 14.0
    root_stiffness: float = math.inf
    leaves: LeafTraits = field(default_factory=LeafTraits)
    rupture: float = 50.0e6
    twig_diameter: float = 0.0029
    look: Look = field(default_factory=Look)
    habit: str = 'broadleaf'
    is_estimate: bool = False

    def __repr__(self) -> str:
        """Return key, title, modulus and density on one line."""
        return (
            f'Species {self.key!r}, {self.title}: modulus {1e-9 * self.modulus:.3g} GPa, '
            f'density {self.density:.4g} kg/m^3'
        )

    def damping(self, in_leaf: bool) -> float:
        """Return the damping ratio with or without leaves in [-]."""
        return self.damping_in_leaf if in_leaf else self.damping_bare

    def drag_law(self, in_leaf: bool) -> tuple[float, float]:
        """Return C and N of ``Cd = C U^-N``; bare branches do not streamline."""
        if in_leaf:
            return self.drag_coefficient, self.drag_exponent
        return self.bare_drag_coefficient, 0.0
