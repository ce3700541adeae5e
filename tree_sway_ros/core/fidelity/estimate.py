# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""How much model a scene needs: what is known of a model unrun, and the least that will do."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tree_sway_ros.core.arrays import Floats
from tree_sway_ros.core.tree.tree import Tree
from tree_sway_ros.errors import ParameterError


@dataclass(frozen=True)
class Estimate:
    """
    What a model, its modes counted, is worth in a wind, and costs per step and placing [us].

    ``error`` bounds the root mean square over time and tips of the error, ``motion`` is that of
    the motion of the tips about its mean, both in [m].
    """

    model: str
    n_modes: int
    error: float
    motion: float
    cost: float
    n_frozen: int = 0

    @property
    def name(self) -> str:
        """As people say it: ``modes 6``, or ``modes 6 with 20 branches frozen``."""
        return model_name(self.model, self.n_modes, self.n_frozen)


def choose(
    estimates: Sequence[Estimate], *, tolerance: float | None = None, budget: float | None = None
) -> Estimate:
    """
    Choose the least model that a scene needs: the cheapest within the tolerance in [m].

    With a budget alone, in [us] per step, the most accurate within it; with both, the cheapest
    within the tolerance among those within the budget. A `ParameterError` names the nearest model
    if none is.
    """
    within = [e for e in estimates if budget is None or e.cost <= budget]
    if not within:
        cheapest = min(estimates, key=lambda e: e.cost)
        raise ParameterError(
            f'no model costs less than {budget:g} us per step',
            where='budget',
            cure=f"allow {cheapest.cost:.3g} us for '{cheapest.name}'",
        )
    if tolerance is None:
        return min(within, key=lambda e: (e.error, e.cost))
    good = [e for e in within if e.error <= tolerance]
    if not good:
        best = min(within, key=lambda e: e.error)
        raise ParameterError(
            f'no model errs less than {tolerance:g} m in this wind',
            where='tolerance',
            cure=f"allow {best.error:.3g} m for '{best.name}', or pin a model",
        )
    return min(good, key=lambda e: e.cost)


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


def model_name(model: str, n_modes: int, n_frozen: int) -> str:
    """Name of a model as people say it."""
    name = f'{model} {n_modes}' if model == 'modes' else model
    is_told = n_frozen > 0 and model != 'frozen'
    return f'{name} with {n_frozen} branches frozen' if is_told else name
