# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The model `full` of a limp tree: inertia, weight and wind load of its pose, on all coordinates.

They are all but those that would rattle (`setup.reductions.FASTEST_LIMP`). The step is that of
``native/limp.h``, in finer parts.
"""

from __future__ import annotations

import math

from tree_sway.core.model import SwayModel
from tree_sway.core.native import NativeStand
from tree_sway.core.run import TableOscillators

LONGEST_PART = 1.0 / 240.0
"""Longest part of a step [s]."""


class LimpFullBank(TableOscillators):
    """A limp tree on all its coordinates, without a table."""

    def __init__(self, model: SwayModel, stand: NativeStand) -> None:
        """Make room for the state."""
        super().__init__(model, stand)
        self._n_parts = 1

    def set_step(self, dt: float) -> None:
        """Refill the coefficients for a time step [s]."""
        super().set_step(dt)
        self._n_parts = math.ceil(dt / LONGEST_PART - 1e-9)
        self.stand.set_step(dt / self._n_parts)

    def advance(self, wx: float, wy: float, wz: float) -> int:
        """Advance one step, as `TableOscillators.advance`."""
        outcome = 0
        for _ in range(self._n_parts):
            of_part = super().advance(wx, wy, wz)
            if of_part < 0:
                return of_part
            outcome += of_part
        return outcome
