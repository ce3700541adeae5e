# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What a scene asks of its trees: an error too small to be seen, a time that a frame may take."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.core.fidelity.adaptive import AdaptiveSimulator
from tree_sway.core.simulator.simulator import SwaySimulator


def set_demand(
    simulators: Iterable[SwaySimulator],
    *,
    tolerance: float,
    budget: float = 0.0,
    camera: ArrayLike | None = None,
    tolerance_angle: float = 5e-4,
) -> None:
    """
    Set what is asked of the trees that choose their model; the others do not mind.

    Parameters
    ----------
    simulators
        One per tree.
    tolerance
        Largest error of the tips in [m], where there is no camera.
    budget
        Largest cost of a frame of all these trees in [us], shared by segments; 0 for none.
    camera
        Its position [m], (3,); None without a camera.
    tolerance_angle
        Largest error as the camera sees it, in [rad].

    """
    adaptive = adaptive_among(simulators)
    total = sum(each.tree.n_segments for each in adaptive)
    for each in adaptive:
        tree = each.tree
        each.budget = budget * tree.n_segments / total
        each.tolerance = tolerance
        if camera is not None:
            # The nearest branch tip or the root is seen, from 1 cm at the nearest.
            seen = np.vstack([tree.start[:1], tree.end[tree.branch_first[1:] - 1]])
            away = np.linalg.norm(seen - np.asarray(camera, dtype=np.float64), axis=1)
            each.tolerance = tolerance_angle * max(float(away.min()), 0.01)


def set_cost_scale(simulators: Iterable[SwaySimulator], spent: float) -> None:
    """Give the trees that choose their model what a frame of them alone takes here, in [us]."""
    adaptive = adaptive_among(simulators)
    expected = sum(each.choice.cost for each in adaptive)
    for each in adaptive:
        each.cost_scale = spent / expected


def adaptive_among(simulators: Iterable[object]) -> list[AdaptiveSimulator]:
    """Return those trees that choose their model."""
    return [each for each in simulators if isinstance(each, AdaptiveSimulator)]
