# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Demands of a scene on its trees: an invisible error, and a budget of time per frame."""

from __future__ import annotations

from collections.abc import Callable, Iterable

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.core.run import SwaySimulator
from tree_sway.core.scene import Simulator
from tree_sway.fidelity.adaptive import AdaptiveSimulator

_FRAMES = 20
"""Number of frames that are timed."""


def set_demand(
    simulators: Iterable[SwaySimulator],
    *,
    tolerance: float,
    budget: float = 0.0,
    camera: ArrayLike | None = None,
    tolerance_angle: float = 5e-4,
) -> None:
    """
    Set tolerance and budget of trees that choose their model.

    Parameters
    ----------
    simulators
        One per tree.
    tolerance
        Largest error of the tips in [m], where there is no camera.
    budget
        Largest cost of a frame of all these trees in [us], shared by segments; 0 for none.
    camera
        Position of the camera [m], (3,); None without a camera.
    tolerance_angle
        Largest error as an angle from the camera, in [rad].

    """
    adaptive = adaptive_among(simulators)
    total = sum(each.tree.n_segments for each in adaptive)
    for each in adaptive:
        tree = each.tree
        each.budget = budget * tree.n_segments / total
        each.tolerance = tolerance
        if camera is not None:
            # The distance is that of the nearest branch tip or the root, at least 1 cm.
            seen = np.vstack([tree.start[:1], tree.end[tree.branch_first[1:] - 1]])
            away = np.linalg.norm(seen - np.asarray(camera, dtype=np.float64), axis=1)
            each.tolerance = tolerance_angle * max(float(away.min()), 0.01)


def measure_costs(simulator: Simulator, dt: float, timer: Callable[[], float]) -> None:
    """
    Step some frames of dt [s], and give trees that choose their model the cost of theirs.

    ``timer`` is a clock in [s]. The trees are at rest afterwards.
    """
    adaptive = adaptive_among(simulator.simulators)
    wind = np.array([1.0, 0.0, 0.0])
    spent = []
    for _ in range(_FRAMES):
        simulator.step(wind, dt)
        simulator.place()
        begin = timer()
        for each in adaptive:
            each.step(wind, dt)
            each.place()
        spent.append(timer() - begin)
    simulator.reset()
    expected = sum(each.choice.cost for each in adaptive)
    for each in adaptive:
        each.cost_scale = 1e6 * min(spent) / expected


def adaptive_among(simulators: Iterable[object]) -> list[AdaptiveSimulator]:
    """Return the trees that choose their model."""
    return [each for each in simulators if isinstance(each, AdaptiveSimulator)]
