# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Energy of a motion and of its correction: no sensor moves a tree beyond its own storms."""

from __future__ import annotations

from tree_sway.core.arrays import Floats
from tree_sway.core.kernel import kernel


@kernel
def find_energies(
    stiffness: Floats, eta: Floats, rate: Floats, correction: Floats, out: Floats
) -> None:
    """
    Find the energy of a motion with and without its correction, both twice and per unit mass.

    Parameters
    ----------
    stiffness
        Stiffness of the first coordinates [1/s^2], (n,).
    eta, rate
        Displacement and rate, (n,) or more.
    correction
        Correction of both, (2, n) or more rows.
    out
        Energy of the corrected and of the uncorrected motion, (2,), written.

    """
    out[:] = 0.0
    for i in range(len(stiffness)):
        k, x, v = stiffness[i], eta[i], rate[i]
        moved, moving = x + correction[0, i], v + correction[1, i]
        out[0] += k * moved * moved + moving * moving
        out[1] += k * x * x + v * v
