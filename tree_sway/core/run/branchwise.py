# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Base of oscillators that are loaded branch by branch."""

from __future__ import annotations

from tree_sway.core.arrays import Floats, Records


class Branchwise:
    """Oscillators on the loads of all branches: there is no table, so no step is outside."""

    n_outside = 0
    work: Records

    def forces(self) -> Floats:
        """Force of the last step's wind on each branch in [N], (b, 3)."""
        forces: Floats = self.work['force']
        return forces
