# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The paper's rotation plane taken literally: rebuilt from branch and wind at each step.

The state is one angle and its rate, in the plane of the branch and the wind of the moment. Kept
for comparison: the plane does not exist where wind and branch are parallel, and an angle reused
while the plane turns with the wind is an angle in a direction the branch never moved in.

"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]


def run_in_rebuilt_plane(loads: Array, row: Array) -> Array:
    """
    Step one branch with the planar equation in the plane of each step's load.

    Parameters
    ----------
    loads
        W along b, e1, e2 in [N m], (steps, 3).
    row
        The branch's coefficients of `oscillators.propagator`, (8,).

    Returns
    -------
    Array
        Unit vector along the branch after each step, (steps + 1, 3); NaN once the plane was
        undefined.

    """
    out = np.empty((len(loads) + 1, 3))
    out[0] = 1.0, 0.0, 0.0
    theta = omega = 0.0
    c0, c1, c2, c3, c4, c5, c6, c7 = row
    for n, (wb, w1, w2) in enumerate(loads):
        across = np.hypot(w1, w2)
        with np.errstate(invalid='ignore'):
            direction = np.array([w1, w2]) / across

        def moment(angle: float, along: float = wb, across: float = across) -> float:
            return float(across * np.cos(angle) - along * np.sin(angle))

        m0 = moment(theta)
        guess = c0 * theta + c1 * omega + (c2 + c3) * m0
        m1 = moment(guess)
        theta, omega = (
            c0 * theta + c1 * omega + c2 * m0 + c3 * m1,
            c4 * theta + c5 * omega + c6 * m0 + c7 * m1,
        )
        out[n + 1] = np.cos(theta), *(np.sin(theta) * direction)
    return out
