# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""How much of the motion the wind alone explains, over the last half minute."""

from __future__ import annotations

import numpy as np

from tree_sway.core.arrays import Floats

_RECENT = 30.0
"""Time constant of the means in [s]."""

_EVERY = 0.1
"""Time between two samples of the means in [s]: energies need no more."""


class ExplainedMotion:
    """
    Energy of the correction over that of the whole motion, both about their means.

    Energies are those of the springs, so that a coordinate counts by how much it bends the tree.
    """

    def __init__(self) -> None:
        self._passed = self._since = 0.0
        self._means: Floats = np.zeros((2, 1))
        self._energies: Floats = np.zeros(2)

    def note(self, dt: float, stiffness: Floats, whole: Floats, added: Floats) -> None:
        """
        Note a step.

        Parameters
        ----------
        dt
            Time since the last one in [s].
        stiffness
            Stiffness of the coordinates, of unit mass, in [1/s^2], (m,).
        whole, added
            Displacements with the correction, and the correction itself, (m,).

        """
        self._since += dt
        if self._since < _EVERY:
            return
        self._passed += self._since
        # Means over all steps until there are more than the time constant.
        share = min(self._since / min(self._passed, _RECENT), 1.0)
        self._since = 0.0
        both = np.stack([whole, added])
        away = both - self._means
        self._means = self._means + share * away
        # Both factors: the mean has moved towards the value (Welford 1962).
        energies = away * (both - self._means) @ stiffness
        self._energies += share * (energies - self._energies)

    @property
    def share(self) -> float:
        """Share that the wind alone explains, 0 to 1; 1 without motion."""
        whole, added = self._energies.tolist()
        return min(max(1.0 - added / whole, 0.0), 1.0) if whole > 0.0 else 1.0
