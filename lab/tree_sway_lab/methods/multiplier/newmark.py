# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Newmark's method on index 3: generalised-alpha without its damping."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from tree_sway_lab.methods.multiplier.generalized_alpha import GeneralizedAlpha


@dataclass(frozen=True)
class Newmark(GeneralizedAlpha):
    """The trapezoidal rule, beta 1/4 and gamma 1/2, on index 3: no damping of the constraint."""

    name: ClassVar[str] = 'newmark'
    notes: ClassVar[str] = 'weakly unstable on index 3: disturbances of the constraint never decay'
    source: ClassVar[str] = 'Newmark 1959, J. Eng. Mech. 85; Cardona and Geradin 1989'

    def weights(self) -> tuple[float, float, float, float]:
        """Return am, af, beta, gamma."""
        return 0.0, 0.0, 0.25, 0.5
