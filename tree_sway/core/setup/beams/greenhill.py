# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The length at which a stem buckles under its own weight."""

from __future__ import annotations

import math


def greenhill_length(bending_stiffness: float, weight_per_length: float) -> float:
    """
    Length [m] at which an upright uniform stem buckles under its own weight (Greenhill, 1881).

    That is ``(7.8373 EI / (rho A g))^(1/3)``, EI in [N m^2], rho A g in [N/m].
    """
    return math.pow(7.8373 * bending_stiffness / weight_per_length, 1.0 / 3.0)
