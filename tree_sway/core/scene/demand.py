# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What a scene asks of its trees: an error that nobody sees, a time that a frame may take."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.core.arrays import Floats
from tree_sway.core.fidelity.adaptive import AdaptiveSimulator
from tree_sway.core.simulator.simulator import SwaySimulator
from tree_sway.core.tree.tree import Tree
from tree_sway.errors import ParameterError


def set_demand(
    simulators: Iterable[SwaySimulator],
    *,
    tolerance: float,
    budget: float = 0.0,
    camera: ArrayLike | None = None,
    tolerance_pixels: float = 0.5,
    focal_length: float = 1000.0,
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


def set_cost_scale(simulators: Iterable[SwaySimulator], spent: float) -> None:
    """Give the trees that choose their model what a frame of them alone takes here, in [us]."""
    adaptive = adaptive_among(simulators)
    expected = sum(each.choice.cost for each in adaptive)
    for each in adaptive:
        each.cost_scale = spent / expected


def adaptive_among(simulators: Iterable[object]) -> list[AdaptiveSimulator]:
    """Return those trees that choose their model."""
    return [each for each in simulators if isinstance(each, AdaptiveSimulator)]


def tolerance_in_metres(pixels: float, distance: float, focal_length: float) -> float:
    """Turn a tolerance [px] on a picture of a focal length [px] into one at a distance, in [m]."""
    if not (pixels > 0.0 and distance > 0.0 and focal_length > 0.0):
        raise ParameterError(
            f'tolerance of {pixels:g} px at {distance:g} m with a focal length of '
            f'{focal_length:g} px',
            cure='give three numbers above 0',
        )
    return pixels * distance / focal_length


def distance_to(tree: Tree, position: Floats) -> float:
    """Distance from a camera (3,) to the nearest branch tip or the root in [m], at least 1 cm."""
    seen = np.vstack([tree.start[:1], tree.end[tree.branch_first[1:] - 1]])
    return max(float(np.linalg.norm(seen - position, axis=1).min()), 0.01)
