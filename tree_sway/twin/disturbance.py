# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Model of the forces on a tree that the wind at one place does not explain.

An anemometer measures one place, and limbs apart from each other meet gusts of their own. Two
places r apart share gusts of a frequency f by the coherence ``exp(-C f r / U)``, C near 8
(Davenport, 1961, Quarterly Journal of the Royal Meteorological Society 87, 194-211): of those that
shake a tree at its first frequency, a mast some metres away tells nothing. The wind of each limb
is therefore unknown, correlated among limbs by that law at the first frequency of the tree.

Its spectrum is that of gusts (Kaimal et al. 1972, same journal 98, 563-589), ``4 s^2 T / (1 + 6 f
T)^(5/3)`` with T = L / U. A first-order process ``4 s^2 t / (1 + (2 pi f t)^2)`` with t = 0.31 T
is within 40 % of it from 0.05 to 2 Hz.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from tree_sway.core.arrays import Floats, Ints
from tree_sway.core.drag import drag_density
from tree_sway.core.setup import base_motion, own_motion
from tree_sway.core.wind.gusts import DECAY, limbs_of, N_DELAYS, parts_of

if TYPE_CHECKING:
    from tree_sway.core.run import SwaySimulator

GUST = 0.3
"""Standard deviation of the unknown wind of a limb over the mean wind [-]."""

_LENGTH = 60.0
"""Integral length L of gusts in [m], that of IEC 61400-1 at 10 m."""

_SHARED = 0.1
"""Variance of an unknown wind of the whole crown over that of a limb [-]."""

_LIFT = 0.3
"""Variance of the vertical unknown wind over that of the horizontal one [-]."""

_SLOPE = 1.5
"""
Slope of the drag by the wind, mean over the two directions across the flow, over drag per speed:
2 along the wind and 1 across it.
"""

_PROJECTOR = [0, 3, 4, 3, 1, 5, 4, 5, 2]


@dataclass(frozen=True)
class Disturbance:
    """
    Unknown forces on the first coordinates of a model in a mean wind.

    ``covariance`` is of the modal forces, (m, m), and ``apart`` what it would be if each limb met
    gusts of its own that move each coordinate as much; ``time_constant`` is the time in [s] after
    which they have decayed to 1/e, ``air_damping`` the damping of each coordinate by the mean wind
    in [1/s], (m,), and ``speed`` that wind in [m/s]; ``drag`` is the force on each coordinate of
    the model against the rate of another in [1/s], (all, all). Of each limb, the stem first,
    ``limb_slopes`` are the force on each coordinate per wind, (l, 3, m), and ``reach`` how far it
    is from the middle of the crown over the farthest one, 0 for the stem, (l,).
    """

    covariance: Floats
    apart: Floats
    time_constant: float
    air_damping: Floats
    speed: float
    drag: Floats
    limb_slopes: Floats
    reach: Floats


def disturbance(simulator: SwaySimulator, speed: float, count: int) -> Disturbance:
    """Find the unknown forces on a number of coordinates in a mean wind [m/s]."""
    branches = simulator.banks[0].branches
    n_all = simulator.banks[0].oscillators.shapes.shape[1]
    all_slopes, moved = _branch_slopes(simulator, speed, n_all)
    drag = np.tensordot(all_slopes, moved, axes=((0, 1), (0, 1)))
    air_damping = np.diag(drag)[:count].copy()
    slope = all_slopes[:, :, :count]

    tree = simulator.tree
    limb = limbs_of(tree.branch_parent)[tree.branch_of_segment[branches['first']]]
    n_limbs = int(limb.max()) + 1
    area = branches['area'][:, None]
    by_limb, load, moment = (
        _summed(each, limb, n_limbs) for each in (slope, area, area * branches['centre'])
    )
    middle = moment / np.maximum(load, 1e-12)
    between = np.linalg.norm(middle[:, None] - middle, axis=2)
    frequency = float(simulator.frequencies(1)[0])
    shared = np.exp(-DECAY * frequency / max(speed, 1.0) * between)
    covariance = np.square(GUST * speed) * _forces_by(by_limb, _SHARED + shared)
    apart = _forces_by(by_limb, np.eye(n_limbs))
    scale = np.sqrt(np.diag(covariance) / np.maximum(np.diag(apart), 1e-300))
    apart *= np.outer(scale, scale)
    reach = np.linalg.norm(middle - load[:, 0] @ middle / load.sum(), axis=1)
    reach[0] = 0.0
    reach /= max(float(reach.max()), 1e-9)
    return Disturbance(
        covariance, apart, 0.31 * _LENGTH / speed, air_damping, speed, drag, by_limb, reach
    )  # fmt: skip


def _forces_by(slopes: Floats, correlation: Floats) -> Floats:
    """Covariance of forces by winds of limbs, slopes (l, 3, m), with a correlation, (l, l)."""
    axes = zip((1.0, 1.0, _LIFT), slopes.swapaxes(0, 1), strict=True)
    return np.asarray(sum(share * along.T @ correlation @ along for share, along in axes))


def crown_slope(simulator: SwaySimulator, speed: float, count: int) -> Floats:
    """Slope of the modal forces by the wind of the whole crown in a mean wind [m/s], (3, m)."""
    return np.asarray(_branch_slopes(simulator, speed, count)[0].sum(axis=0))


def part_slopes(simulator: SwaySimulator, speed: float, count: int) -> Floats:
    """Slope of the modal forces by the wind of each part of the crown (`parts_of`), (g, 3, m)."""
    tree = simulator.tree
    slopes, _ = _branch_slopes(simulator, speed, count)
    branch = tree.branch_of_segment[simulator.banks[0].branches['first']]
    return _summed(slopes, parts_of(tree).of_branch[branch], N_DELAYS)


def _summed(values: Floats, group: Ints, n_groups: int) -> Floats:
    """Sum values of branches (b, ...) in groups, (g, ...), whose numbers are given, (b,)."""
    found = np.zeros((n_groups, *values.shape[1:]))
    np.add.at(found, group, values)
    return found


def _branch_slopes(simulator: SwaySimulator, speed: float, count: int) -> tuple[Floats, Floats]:
    """Slopes of modal forces by the wind of each branch, and the motion it damps, (b, 3, m)."""
    branches = simulator.banks[0].branches
    shapes = np.ascontiguousarray(simulator.banks[0].oscillators.shapes[:, :count])
    bases = base_motion(branches, shapes)
    at = bases[:, :3] + branches['coupling'].swapaxes(1, 2) @ bases[:, 3:]
    pushed = at + own_motion(branches, 'load_mode', shapes)
    projector = branches['projector'][:, _PROJECTOR].reshape(-1, 3, 3)
    per_speed = drag_density(speed, *simulator.models[0].drag_law) * speed
    area = _SLOPE * per_speed * branches['speed'] * branches['area']
    moved = at + own_motion(branches, 'damping_mode', shapes)
    return area[:, None, None] * (projector @ pushed), moved
