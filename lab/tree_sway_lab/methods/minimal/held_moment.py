# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What exact methods share: the moment beside the straight chain's, and its propagation."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tree_sway_lab.kernel import kernel
from tree_sway_lab.methods.dense import solve
from tree_sway_lab.methods.minimal_form import coupling, joint, moments

Array = NDArray[Any]


@kernel
def rest_moment(table: Array, theta: Array, omega: Array, load: Array) -> Array:
    """
    Moment N in ``M0 theta'' + C theta' + K theta = N``, M0 the straight chain's, (n,) [N m].

    For one segment it is the load's moment; a chain adds what its bend changes in the inertia.
    """
    n = len(table)
    out = moments(table, theta, load)
    if n == 1:
        return out
    a, straight = coupling(table), coupling(table)
    rhs = np.empty((n, 1), theta.dtype)
    spring, damper = joint(table, 4, theta), joint(table, 5, omega)
    for i in range(n):
        rhs[i, 0] = out[i] - spring[i] - damper[i]
        for j in range(n):
            if j != i:
                turn = theta[i] - theta[j]
                centre = a[i, j] * np.sin(turn) * omega[j] * omega[j]
                out[i] = out[i] - centre
                rhs[i, 0] = rhs[i, 0] - centre
                a[i, j] = a[i, j] * np.cos(turn)
    bend = straight - a
    solve(a, rhs)
    for i in range(n):
        for j in range(n):
            if j != i:
                out[i] = out[i] + bend[i, j] * rhs[j, 0]
    return out


@kernel
def apply(options: Array, hold: int, rows: Array, moment: Array) -> Array:
    """Propagate angles and rates under the moment of the start; with hold, over all the step."""
    n = len(moment)
    out = np.empty((2, n), rows.dtype)
    for part in range(2):
        for i in range(n):
            at = part * n + i
            total = options[at, 0] * rows[0, 0]
            for j in range(1, n):
                total = total + options[at, j] * rows[0, j]
            for j in range(n):
                weight = options[at, 2 * n + j]
                if hold:
                    weight = weight + options[at, 3 * n + j]
                total = total + options[at, n + j] * rows[1, j] + weight * moment[j]
            out[part, i] = total
    return out
