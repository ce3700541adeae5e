# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Growth of free motion under a method in angles, and the largest step at which it does not grow.

Free motion of a single segment is linear, so one step of a method is a 2 x 2 matrix that acts on
angle and rate. It is found by running the method itself from two unit states.

"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tree_sway_lab.methods.chain import PlanarChain, single_segment
from tree_sway_lab.methods.method import Method

Array = NDArray[Any]

_ROUNDING = 1e-9
"""Growth per step [-] that is taken for rounding."""


def free_step(method: Method, chain: PlanarChain, dt: float) -> Array:
    """Return the matrix of a step without load on (angle, rate) of a single segment, (2, 2)."""
    options = method.options(chain, dt)
    calm = np.zeros((len(method.nodes), 1, 2))
    columns = []
    for angle, rate in np.eye(2):
        state = method.start(chain, np.array([angle]), np.array([rate]), calm[0], dt)
        type(method).kernel(chain.table, state, calm, dt, options)
        columns.append([method.angles(state)[0], method.rates(state)[0]])
    return np.transpose(columns)


def growth(method: Method, ratio: float, damping_ratio: float = 0.0) -> float:
    """Return the largest factor [-] by which one step of w h can multiply free motion."""
    chain = single_segment(ratio / (2.0 * np.pi), damping_ratio)
    return float(np.max(np.abs(np.linalg.eigvals(free_step(method, chain, dt=1.0)))))


def stability_limit(method: Method, damping_ratio: float = 0.0) -> float:
    """
    Return the largest w h [-] at which free motion does not grow; infinite where it never does.

    It is the first crossing, found by a scan from 0.01 to 10,000 and by bisection.
    """

    def is_stable(ratio: float) -> bool:
        return growth(method, ratio, damping_ratio) <= 1.0 + _ROUNDING

    scan = np.geomspace(1e-2, 1e4, 600)
    unstable = next((ratio for ratio in scan if not is_stable(ratio)), None)
    if unstable is None:
        return float(np.inf)
    low, high = unstable * scan[0] / scan[1], unstable
    for _ in range(50):
        middle = 0.5 * (low + high)
        if is_stable(middle):
            low = middle
        else:
            high = middle
    return float(low)
