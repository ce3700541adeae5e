# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Model of the forces on a tree that the wind at one place does not explain.

An anemometer measures one place, and limbs apart from each other meet gusts of their own. Two
places r apart share gusts of a frequency f by the root coherence ``exp(-C f r / U)``, C near 8
(Davenport, 1961, Quarterly Journal of the Royal Meteorological Society 87, 194-211): of those that
shake a tree at its first frequency, a mast some metres away tells nothing. The wind of each limb
is therefore unknown. Most of the motion is a lean in gusts that are slower than a quarter of that
frequency, and limbs share the unknown wind by that law at this quarter.

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
from tree_sway.core.rotation import about_up
from tree_sway.core.setup import base_motion, own_motion
from tree_sway.core.wind.gusts import DECAY, limbs_of, N_DELAYS, parts_of

if TYPE_CHECKING:
    from tree_sway.core.run import SwaySimulator

GUST = 0.3
"""Standard deviation of the unknown wind of a limb over the mean wind [-]."""

_LENGTH = 60.0
"""Integral length L of gusts in [m], that of IEC 61400-1 at 10 m."""

_SHORTER = 0.31
"""Time constant of the first-order process over L / U [-]."""

_LEAN = 0.25
"""Frequency whose coherence limbs have, over the first one of the tree [-]."""

_LIFT = 0.3
"""Variance of the vertical unknown wind over that of the horizontal one [-]."""

_SLOPE = 1.5
"""
Slope of the drag by the wind, mean over the two directions across the flow, over drag per speed:
2 along the wind and 1 across it.
"""

ALONG, ACROSS = 4.0 / 3.0, 2.0 / 3.0
"""These slopes along the wind and across it, over their mean."""

_LATERAL = 0.8
"""Deviation of gusts across the mean wind over that along it [-] (IEC 61400-1)."""

_PROJECTOR = [0, 3, 4, 3, 1, 5, 4, 5, 2]


@dataclass(frozen=True)
class Disturbance:
    """
    Unknown forces on the first coordinates of a model in a mean wind.

    Parameters
    ----------
    covariance
        Covariance of the modal forces, (m, m).
    apart
        What it would be if each limb met gusts of its own that move each coordinate as much.
    time_constant
        Time in [s] after which they have decayed to 1/e.
    air_damping
        Damping of each coordinate by the mean wind in [1/s], (m,).
    speed
        That wind in [m/s].
    drag
        Force on each coordinate of the model against the rate of another in [1/s], (all, all).
    limb_slopes
        Force on each coordinate per wind of each limb, the stem first, (l, 3, m).
    reach
        How far each limb is from the middle of the crown over the farthest one, 0 for the stem,
        (l,).

    """

    covariance: Floats
    apart: Floats
    time_constant: float
    air_damping: Floats
    speed: float
    drag: Floats
    limb_slopes: Floats
    reach: Floats


def disturbance(
    simulator: SwaySimulator, speed: float, count: int, heading: float | None = None
) -> Disturbance:
    """
    Find the unknown forces on a number of coordinates in a mean wind [m/s].

    It goes to a heading from east to north [rad], or anywhere.
    """
    n_all = simulator.banks[0].oscillators.shapes.shape[1]
    slopes, moved = _branch_slopes(simulator, speed, n_all)
    drag = np.tensordot(slopes, moved, axes=((0, 1), (0, 1)))
    air_damping = np.diag(drag)[:count].copy()
    limb_slopes, middle, reach = _limbs(simulator, slopes[:, :, :count])

    between = np.linalg.norm(middle[:, None] - middle, axis=2)
    frequency = _LEAN * simulator.frequencies(1)[0]
    shared = np.exp(-DECAY * frequency / max(speed, 1.0) * between)
    variance = np.square(GUST * speed)
    covariance = variance * _forces_by(limb_slopes, shared, heading)
    apart = _forces_by(limb_slopes, np.eye(len(between)), heading)
    scale = np.sqrt(np.diag(covariance) / np.maximum(np.diag(apart), 1e-300))
    return Disturbance(
        covariance,
        apart * np.outer(scale, scale),
        time_constant=_SHORTER * _LENGTH / speed,
        air_damping=air_damping,
        speed=speed,
        drag=drag,
        limb_slopes=limb_slopes,
        reach=reach,
    )


def _limbs(simulator: SwaySimulator, slopes: Floats) -> tuple[Floats, Floats, Floats]:
    """
    Sum what moves branches, with slopes (b, 3, m), over their limbs.

    Returns the slopes of each limb, (l, 3, m), the middle of its load [m], (l, 3), and its reach.
    """
    tree, branches = simulator.tree, simulator.banks[0].branches
    branch = tree.branch_of_segment[branches['first']]
    limb = limbs_of(tree.branch_parent)[branch]
    n_limbs = int(limb.max()) + 1
    area = branches['area'][:, None]
    load = _summed(area, limb, n_limbs)
    moment = _summed(area * branches['centre'], limb, n_limbs)
    middle = moment / np.maximum(load, 1e-12)
    of_crown = load[:, 0] @ middle / load.sum()
    reach = np.linalg.norm(middle - of_crown, axis=1)
    reach[0] = 0.0
    reach /= max(reach.max(), 1e-9)
    return _summed(slopes, limb, n_limbs), middle, reach


def _forces_by(slopes: Floats, correlation: Floats, heading: float | None) -> Floats:
    """Covariance of forces by winds of limbs, slopes (l, 3, m), with a correlation, (l, l)."""
    variances = 1.0, 1.0, _LIFT
    if heading is not None:
        variances = ALONG**2, (ACROSS * _LATERAL) ** 2, _LIFT
        slopes = np.einsum('ij,ljm->lim', about_up(-heading), slopes)
    pairs = zip(variances, slopes.swapaxes(0, 1), strict=True)
    return np.sum([each * (along.T @ correlation @ along) for each, along in pairs], axis=0)


def crown_slope(simulator: SwaySimulator, speed: float, count: int) -> Floats:
    """Slope of the modal forces by the wind of the whole crown in a mean wind [m/s], (3, m)."""
    slopes, _ = _branch_slopes(simulator, speed, count)
    return slopes.sum(axis=0)


def part_slopes(simulator: SwaySimulator, speed: float, count: int) -> Floats:
    """Slope of the modal forces by the wind of each part of the crown (`parts_of`), (g, 3, m)."""
    tree = simulator.tree
    slopes, _ = _branch_slopes(simulator, speed, count)
    branch = tree.branch_of_segment[simulator.banks[0].branches['first']]
    part = parts_of(tree).of_branch[branch]
    return _summed(slopes, part, N_DELAYS)


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
    carried = branches['coupling'].swapaxes(1, 2) @ bases[:, 3:]
    base = bases[:, :3] + carried
    pushed = base + own_motion(branches, 'load_mode', shapes)
    moved = base + own_motion(branches, 'damping_mode', shapes)
    density = drag_density(speed, *simulator.models[0].drag_law)
    per_area = _SLOPE * density * speed * branches['speed']
    per_speed = per_area * branches['area']
    projector = branches['projector'][:, _PROJECTOR].reshape(-1, 3, 3)
    slopes = per_speed[:, None, None] * (projector @ pushed)
    return slopes, moved
