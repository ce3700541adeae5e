# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Wind load on a branch: one load centre, so that its cost does not depend on the segments.

The force on a piece is ``1/2 rho Cd(U) dA |U_n| U_n``, U_n the velocity of the air relative to the
piece, across it. Summed over a branch it acts at the centre of the load, on the mean displacement
of the loaded pieces; in wind its damping acts on the displacement that gives the same damping as
the sum. In still air the pieces' own speeds count, which differ: their variance is added, so that
the damping is that of the sum there too. Wood has the drag of a cylinder; leaves streamline: Cd =
C U^-N (Mayhead 1973; Vollsinger et al. 2005) between 4 and 20 m/s, constant outside. Those are the
speeds at which crowns were measured in wind tunnels (Rudnicki et al. 2004; Vollsinger et al.
2005).

**Sheltering is assumed, not modelled.** Leaves hide each other by the outline of the crown, and
shelter each other as in the crowns on which their law was measured; twigs clad in needles are part
of such a crown. Bare wood and branches of leaves meet the whole wind.

**Implicit in the branch's own motion.** A light twig follows the air within a fraction of a step,
where an explicit drag would be unstable. With u the velocity of the branch at the middle of the
step without the force, and beta the velocity per unit of force by then, the relative speed s
solves ``s + beta c s^2 = |U - u|`` in closed form: stable for any wind and step, second order in
the step.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from tree_sway.core.arrays import Floats

AIR_DENSITY = 1.225
"""Density of dry air at 15 degrees C and sea level in [kg/m^3] (ISO 2533)."""

STREAMLINING_FROM, STREAMLINING_TO = 4.0, 20.0
"""Wind speeds in [m/s] between which the drag law is measured."""

SHARED_AT = 8.0
"""Wind speed in [m/s] at which the shares of wood and leaves of each branch are exact."""


class DragLaw(NamedTuple):
    """Drag of a tree, ``Cd = C U^-N + C0``: C and N for leaves, which streamline, C0 for wood."""

    coefficient: float
    exponent: float
    steady: float = 0.0

    def dynamic_pressure(self, speed: float) -> float:
        """Return the drag per area in a wind in [m/s], in [kg/m/s^2]."""
        return drag_density(speed, *self) * speed**2


def crown_drag(
    wood_area: float, leaf_area: Floats, clad_wood: Floats,
    wood: float, leaves: tuple[float, float],
) -> tuple[DragLaw, Floats]:  # fmt: skip
    """
    Return the drag law of a tree whose wood has the drag of cylinders and whose leaves streamline.

    All branches share one law; each has the area that gives the right share of wood and leaves at
    `SHARED_AT`.

    Parameters
    ----------
    wood_area
        Area of all wood in [m^2].
    leaf_area, clad_wood
        Area of the leaves of each branch, and of its wood clad in them, in [m^2], (b,).
    wood
        Drag coefficient of bare wood in [-].
    leaves
        C and N of ``Cd = C U^-N`` of the leafy area.

    Returns
    -------
    law, area
        Drag law, and the equivalent area of bare wood of the leaves of each branch in [m^2], (b,).

    """
    coefficient, exponent = leaves
    weighted = coefficient * math.pow(SHARED_AT, -exponent) / wood * leaf_area
    added = np.maximum(weighted - clad_wood, 0.0)
    whole = wood_area + float(added.sum())
    leafy = coefficient * float(leaf_area.sum()) / whole
    steady = wood * (whole - float(weighted.sum())) / whole
    return DragLaw(leafy, exponent, steady), added


def drag_density(speed: float, coefficient: float, exponent: float, steady: float = 0.0) -> float:
    """Drag per area and speed squared, ``1/2 rho (C U^-N + C0)``, in [kg/m^3], U in [m/s]."""
    if exponent == 0.0:
        return 0.5 * AIR_DENSITY * (coefficient + steady)
    streamlined = min(max(speed, STREAMLINING_FROM), STREAMLINING_TO)
    return 0.5 * AIR_DENSITY * (coefficient * math.pow(streamlined, -exponent) + steady)
