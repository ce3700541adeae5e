# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What a scene asks of its trees: an error that nobody sees, a time that a frame may take."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import ArrayLike

from tree_sway_ros.core.fidelity.adaptive import AdaptiveSimulator
from tree_sway_ros.core.fidelity.estimate import distance_to, tolerance_in_metres
from tree_sway_ros.core.simulator.protocol import TreeSimulator


def set_demand(
    simulators: Iterable[TreeSimulator],
    *,
    tolerance: float,
    budget: float = 0.0,
    camera: ArrayLike | None = None,
    tolerance_pixels: float = 0.5,
    focal_length: float = 1000.0,
) -> None:
    """
    Tell the trees that choose their model what is asked of them; the others do not mind.

    Parameters
    ----------
    simulators
        One per tree.
    tolerance
        Largest error of the tips in [m], where there is no camera.
    budget
        Largest cost of a frame of all these trees in [us], shared by segments; 0 for none.
    camera
        Where it stands in [m], (3,); None if there is none.
    tolerance_pixels, focal_length
        Largest error on its picture, and its focal length, both in [px].

    """
    adaptive = adaptive_among(simulators)
    total = sum(each.tree.n_segments for each in adaptive)
    for each in adaptive:
        each.budget = budget * each.tree.n_segments / total
        each.tolerance = tolerance
        if camera is not None:
            distance = distance_to(each.tree, np.asarray(camera, dtype=np.float64))
            each.tolerance = tolerance_in_metres(tolerance_pixels, distance, focal_length)


def set_pace(simulators: Iterable[TreeSimulator], spent: float) -> None:
    """Tell the trees that choose their model what a frame of all takes here and now, in [us]."""
    adaptive = adaptive_among(simulators)
    foreseen = sum(each.choice.cost for each in adaptive)
    for each in adaptive:
        each.pace = spent / foreseen


def adaptive_among(simulators: Iterable[object]) -> list[AdaptiveSimulator]:
    """Return those trees that choose their model."""
    return [each for each in simulators if isinstance(each, AdaptiveSimulator)]
