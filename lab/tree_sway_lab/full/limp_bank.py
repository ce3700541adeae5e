# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The model `full` of a limp tree: inertia, weight and wind load of its pose, on all coordinates.

They are all but those that would rattle (`setup.reductions.FASTEST_LIMP`). The step is that of
`core.run.limp_tree`, in parts of a frame; in storms and after a step that turns a branch too far
it is that of `FullBank`.
"""

from __future__ import annotations

import math

import numpy as np

from tree_sway.core.arrays import Records
from tree_sway.core.model.sway_model import SwayModel
from tree_sway.core.run.limp_tree import LimpStep, LONGEST_STEP
from tree_sway.core.setup.numpy_branch_loads import of_slots
from tree_sway_lab.full.bank import Air, FullBank

LONGEST_PART = 1.0 / 240.0
"""Longest part of a step [s] that is taken at once."""


class LimpFullBank(LimpStep, FullBank):
    """A limp tree on all its coordinates."""

    def __init__(self, branches: Records, model: SwayModel) -> None:
        """Make room for the state."""
        super().__init__(branches, model)
        self._n_parts = 1
        self._wanted = np.zeros(len(model.stiffness))
        self._first = model.branch_first[:-1]
        self.leading = len(model.stiffness)

    def set_step(self, dt: float) -> None:
        """Refill the coefficients for a time step [s]."""
        # Longer ones are steps of `FullBank`.
        is_short = dt <= LONGEST_STEP
        self._n_parts = max(1, math.ceil(dt / LONGEST_PART - 1e-9)) if is_short else 1
        part = dt / self._n_parts
        super().set_step(part)
        half = self.half.T[[0, 1, 2, 4, 5, 6]]
        self.take_step(self, half, self.swing, self._wanted, part)

    def advance(self, wx: float, wy: float, wz: float) -> int:
        """Advance one step, as `FullBank.advance`."""
        density = self.density(wx, wy, wz)
        gust = of_slots(self.loads['gust'], len(self.branches))
        self.segments.gust[:] = gust[self.segments.branch]
        n_clamped = 0
        for _ in range(self._n_parts):
            outcome = self.step_once(wx, wy, wz, density)
            if outcome < 0:
                return outcome
            n_clamped += outcome
        return n_clamped

    def step_otherwise(self, wx: float, wy: float, wz: float, per_speed_squared: float) -> int:
        """Make the step under the loads of the branches."""
        return self.advance_in(Air(wx, wy, wz, per_speed_squared))

    def note_wind(self, wx: float, wy: float, wz: float, per_speed_squared: float) -> None:
        """Sum the forces of a step at the pose over the segments of each branch."""
        drag = self.segments
        on_segments = drag.root_mass[:, None] * drag.force.reshape(-1, 3)
        on_branches = np.add.reduceat(on_segments, self._first)
        self.work['force'] = per_speed_squared * on_branches

    def reset(self) -> None:
        """Return to rest."""
        super().reset()
        self.begin_anew()
