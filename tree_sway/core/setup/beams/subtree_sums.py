# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Sums over the subtrees that a branch carries: drag, force of the wind and mass, and moments."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tree_sway.core.arrays import Floats, Ints
from tree_sway.core.rotation import cross


class SubtreeSums(NamedTuple):
    """
    Sums over the subtree of each child of a branch, about the root of the tree.

    Parameters
    ----------
    area, area_moment
        Drag area in [m^2], (c,), and its first moment in [m^3], (c, 3).
    force, moment
        Force of winds along x, y and z, as in `wind_loads`, and its moment about the root of the
        tree, both (c, 3, 3), the wind first.
    mass, mass_moment, mass_second
        Mass in [kg], (c,), its first moment in [kg m], (c, 3), and second in [kg m^2], (c, 3, 3).

    """

    area: Floats
    area_moment: Floats
    force: Floats
    moment: Floats
    mass: Floats
    mass_moment: Floats
    mass_second: Floats

    @classmethod
    def zeros(cls, count: int) -> SubtreeSums:
        """Return zero sums over a number of subtrees."""
        return cls(
            area=np.zeros(count),
            area_moment=np.zeros((count, 3)),
            force=np.zeros((count, 3, 3)),
            moment=np.zeros((count, 3, 3)),
            mass=np.zeros(count),
            mass_moment=np.zeros((count, 3)),
            mass_second=np.zeros((count, 3, 3)),
        )

    def select(self, children: Ints) -> SubtreeSums:
        """Select some of the subtrees."""
        return SubtreeSums(*(sums[children] for sums in self))

    def inertial_wrench(self, base: Floats, turn: Floats, moved: Floats) -> tuple[Floats, Floats]:
        """
        Return the inertia of subtrees that move as rigid bodies, by unit of acceleration.

        Parameters
        ----------
        base
            Base of each subtree in [m], (c, 3).
        turn, moved
            Rotation about the base, and displacement of the base, in k cases, both (c, k, 3).

        Returns
        -------
        tuple
            Force, and moment about the root of the tree, both (c, k, 3).

        """
        moved_root = moved - cross(turn, base[:, None])
        mass_moment = self.mass_moment[:, None]
        force = self.mass[:, None, None] * moved_root + cross(turn, mass_moment)
        # Inertia I = trace(S) 1 - S of the second moment S.
        trace = np.trace(self.mass_second, axis1=1, axis2=2)[:, None, None]
        spin = trace * turn - np.einsum('cij,ckj->cki', self.mass_second, turn)
        return force, cross(mass_moment, moved_root) + spin
