# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The HHT method on index 3: generalised-alpha with one weight."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from tree_sway_lab.methods.multiplier.generalized_alpha import GeneralizedAlpha


@dataclass(frozen=True)
class Hht(GeneralizedAlpha):
    """
    Hilber, Hughes and Taylor: Newmark with some damping of the fast part.

    Parameters
    ----------
    alpha
        Weight of the old forces [-], 0 to 1/3.

    """

    alpha: float = 0.1

    name: ClassVar[str] = 'hht'
    notes: ClassVar[str] = 'stable for any w h and alpha in (0, 1/3]'
    source: ClassVar[str] = 'Hilber, Hughes, Taylor 1977; Negrut et al. 2007 (index 3)'

    def weights(self) -> tuple[float, float, float, float]:
        """Return am, af, beta, gamma."""
        return 0.0, self.alpha, 0.25 * (1.0 + self.alpha) ** 2, 0.5 + self.alpha
