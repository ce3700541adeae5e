# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The model `full` of a limp tree: inertia, weight and wind load of its pose, on all coordinates.

They are all but those that would rattle (`setup.reductions.FASTEST_LIMP`). The step is that of
`core.run.limp_tree`, in finer parts.
"""

from __future__ import annotations

import numpy as np

from tree_sway.core.arrays import Records
from tree_sway.core.model.records import WIDTH
from tree_sway.core.model.sway_model import SwayModel
from tree_sway.core.run.limp_tree import LimpStep, SHORTEST_PART
from tree_sway_lab.full.bank import FullBank


class LimpFullBank(LimpStep, FullBank):
    """A limp tree on all its coordinates."""

    longest_part = SHORTEST_PART

    def __init__(self, branches: Records, model: SwayModel) -> None:
        """Make room for the state."""
        super().__init__(branches, model)
        self._first = model.branch_first[:-1]
        self.leading = len(model.stiffness)

    def set_step(self, dt: float) -> None:
        """Refill the coefficients for a time step [s]."""
        self.take_step(self, self.swing, dt)
        super().set_step(dt)

    def advance(self, wx: float, wy: float, wz: float) -> int:
        """Advance one step, as `FullBank.advance`."""
        density = self.density(wx, wy, wz)
        drag = self.segments
        block, slot = np.divmod(np.arange(len(self.branches)), WIDTH)
        gust = self.loads['gust'][block, :, slot]
        drag.gust[:] = gust[drag.branch]
        outcome = self.step_at_pose(wx, wy, wz, density)
        on_segments = drag.root_mass[:, None] * drag.force.reshape(-1, 3)
        on_branches = np.add.reduceat(on_segments, self._first)
        self.work['force'] = density * on_branches
        return outcome

    def reset(self) -> None:
        """Return to rest."""
        super().reset()
        self.begin_anew()
