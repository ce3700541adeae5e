# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Base of oscillators that are loaded branch by branch."""

from __future__ import annotations

from typing import Any, NamedTuple

from tree_sway.core.arrays import Floats, Records


class Tunable(NamedTuple):
    """
    Arrays that a tuning writes, one number per oscillator, and their parts.

    ``weight`` is the part of the stiffness by gravity, negative where it softens; ``inertia`` is 1
    of modes; ``others`` are proportional to a power of the stiffness of the wood; ``loss`` is the
    damping ratio of each over that of the tree.
    """

    stiffness: Floats
    damping: Floats
    inertia: Floats | float
    weight: Floats
    others: tuple[tuple[Floats, float], ...] = ()
    loss: Floats | float = 1.0


class Branchwise:
    """Oscillators on the loads of all branches: there is no table, so no step is outside."""

    n_outside = 0
    to_place = None
    work: Records

    def stepping(self, *_: Any) -> None:
        """Return no compiled call: a step takes the limbs' winds as well."""

    def step_outside(self) -> int:
        """Return that no load was clamped: there is no such step."""
        return 0

    def forces(self) -> Floats:
        """Force of the last step's wind on each branch in [N], (b, 3)."""
        forces: Floats = self.work['force']
        return forces
