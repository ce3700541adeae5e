# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Where motion sensors tell most of a tree.

Of the stem and its stoutest limbs, that place is added to those before which leaves the least
variance of the tips, by the covariance that the filter expects (`steady_filter`). Adding one after
the other is near the best choice of all at once (Krause, Singh & Guestrin 2008, Journal of Machine
Learning Research 9, 235-284).
"""

from __future__ import annotations

from typing import NamedTuple, TYPE_CHECKING

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.setup import one_thread
from tree_sway.core.tree import Tree
from tree_sway.twin.alignment import LEAST_NOISE
from tree_sway.twin.observer import MOST_COORDINATES
from tree_sway.twin.sensor_place import place_motion, place_on, tip_slopes
from tree_sway.twin.sensor_track import as_felt, sensed_rows
from tree_sway.twin.steady_filter import stationary_covariance, steady_filter
from tree_sway.twin.unknown_motion import UnknownMotion

if TYPE_CHECKING:
    from tree_sway.core.run import SwaySimulator

_MOST_LIMBS = 16
_ON_STEM, _ON_LIMBS = (0.4, 0.6, 0.8), (0.5, 0.8)
"""Shares of the length at which a sensor may sit."""

_DT = 1.0 / 60.0


class AdvisedPlace(NamedTuple):
    """A place as `place_on` takes it, and the deviation left by it and those before it [-]."""

    at: str
    left: float


def advised_places(simulator: SwaySimulator, count: int, speed: float = 7.0) -> list[AdvisedPlace]:
    """
    Find places for a number of sensors, the one that tells most first.

    Parameters
    ----------
    simulator
        The tree, of a number of coordinates.
    count
        Number of sensors.
    speed
        Mean wind in [m/s].

    Returns
    -------
    list[AdvisedPlace]
        Places, each with the deviation of the tips beyond the motion in the wind alone, over that
        without any sensor.

    """
    tree = simulator.tree
    n = min(MOST_COORDINATES, simulator.banks[0].oscillators.shapes.shape[1])
    with one_thread():
        unknown = UnknownMotion(simulator, n, _DT)
        unknown.note_wind(0.0, 0.0, speed)  # from anywhere
        law, _ = unknown.find()
        slopes = tip_slopes(simulator)[:, :, :n].reshape(-1, n)
        weight = slopes.T @ slopes
        alone = float((weight * stationary_covariance(law)[:n, :n]).sum())
        noise = np.repeat(LEAST_NOISE[:2], 3)
        rows: dict[str, Floats] = {}
        for at in _candidates(tree):
            motion = place_motion(simulator, place_on(tree, at)).first(n)
            rows[at] = as_felt(sensed_rows(motion, unknown.stiffness, unknown.damped))[:6]
        found: list[AdvisedPlace] = []
        chosen = np.zeros((0, 3 * n))
        while rows and len(found) < count:
            left = {}
            for at, felt in rows.items():
                sensed = np.concatenate([chosen, felt])
                gains = steady_filter(law, sensed, np.tile(noise, len(found) + 1))
                left[at] = float((weight * gains.covariance[:n, :n]).sum())
            best = min(left, key=left.__getitem__)
            chosen = np.concatenate([chosen, rows.pop(best)])
            found.append(AdvisedPlace(best, float(np.sqrt(left[best] / alone))))
    return found


def _candidates(tree: Tree) -> list[str]:
    """Name places on the stem and on the stoutest limbs."""
    first, names = tree.branch_first, tree.branch_names
    limbs = np.flatnonzero(tree.branch_parent == 0)
    stoutest = limbs[np.argsort(-tree.base_diameter[first[limbs]], kind='stable')[:_MOST_LIMBS]]
    places = [f'{names[0]}:{share}' for share in _ON_STEM]
    return places + [f'{names[b]}:{share}' for b in stoutest.tolist() for share in _ON_LIMBS]
