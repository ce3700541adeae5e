# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The model of no coordinates: a tree that the wind does not move."""

from __future__ import annotations

import numpy as np

from tree_sway.core.arrays import Floats, Records
from tree_sway.core.model import SwayModel, WIDTH
from tree_sway.core.run.modal_coordinates import ModalCoordinates


class RigidBank(ModalCoordinates):
    """A tree without coordinates; it is bent by pushes alone, as its branches are."""

    n_outside = 0
    """There is no table, so no step is outside."""

    def __init__(self, model: SwayModel) -> None:
        """Make the arrays of a tree at rest."""
        super().__init__(model)
        blocks = -(-len(self.branches) // WIDTH)
        self.loads: Records = np.zeros(blocks, [('gust', 'f8', (3, WIDTH))])
        """The wind of each branch, which no branch feels."""
        self.swing = tuple(np.zeros((3, 0)))
        """Displacement, rate and force of each coordinate, (0,)."""
        self._rest = np.zeros(len(self.shapes))

    def set_step(self, dt: float) -> None:
        """Note the step: there is nothing that moves in it."""
        self.dt = dt

    def advance(self, *_: float) -> int:
        """Return that no load was clamped."""
        return 0

    def memory(self) -> tuple[Floats, ...]:
        """Return views of the state: there is none."""
        return ()

    def rotations(self) -> Floats:
        """Key rotations in [rad], (N,): 0."""
        return self._rest

    def motion(self) -> tuple[Floats, Floats]:
        """Key rotations in [rad] and their rates in [rad/s], both (N,): 0."""
        return self._rest.copy(), self._rest.copy()

    def take_over(self, x: Floats, v: Floats) -> None:
        """Stay at rest."""

    def forces(self) -> Floats:
        """Force of the wind on each branch, (b, 3): not computed, 0."""
        return np.zeros((len(self.branches), 3))

    def reset(self) -> None:
        """Stay at rest."""
