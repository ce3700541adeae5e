# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Modal forces of a uniform wind from the table of a tree (`setup.load_table` has the equation).

A wind and a lean lie between four poses of the table: at the azimuths before and after the wind,
and at the levels of the lean below and above that of the tree. Every field is interpolated between
these four corners.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.kernel import part
from tree_sway.core.model.records import Instance, N_AZIMUTHS, N_LEVELS, Table
from tree_sway.core.model.spherical_harmonics import fill_harmonics

STEEP = math.sin(math.radians(45.0))
"""Sine of the elevation above which slopes are blended with those of vertical wind."""


class UniformWind(NamedTuple):
    """A wind that is the same at all branches."""

    x: float
    """Components of its unit vector."""
    y: float
    z: float
    dynamic_pressure: float
    """``p U^2`` in [kg/m/s^2], U the speed."""
    per_speed_squared: float
    """`drag_law.pressure` p in [kg/m^3]."""


class Corners(NamedTuple):
    """The four corners around a wind and a lean."""

    before: int
    """Azimuth before that of the wind."""
    after: int
    below: int
    """Level below the lean of the tree; the other is the next."""
    above: int
    azimuth_share: float
    """Fraction of the way from the azimuth before to the one after."""
    level_share: float
    """Fraction of the way from the level below to the one above."""


class Weights(NamedTuple):
    """Bilinear weights of the corners. Their sum is 1 in winds that are not steep."""

    before_below: float
    before_above: float
    after_below: float
    after_above: float


@part
def find_corners(table: Table, x: float, y: float, eta: Floats) -> Corners:
    """Find the corners around a horizontal direction and the lean at some coordinates (m,)."""
    position = math.atan2(y, x) * (0.5 / math.pi) * N_AZIMUTHS
    whole = math.floor(position)
    share = position - whole
    before = int(whole) % N_AZIMUTHS
    after = (before + 1) % N_AZIMUTHS
    rest = 1.0 - share
    lean = 0.0
    for i in range(len(eta)):
        lean += (rest * table.amount[before, i] + share * table.amount[after, i]) * eta[i]
    level = 0
    low = rest * table.levels[before, 0] + share * table.levels[after, 0]
    high = rest * table.levels[before, 1] + share * table.levels[after, 1]
    while level < N_LEVELS - 2 and lean > high:
        level += 1
        low = high
        high = rest * table.levels[before, level + 1] + share * table.levels[after, level + 1]
    level_share = min(max((lean - low) / (high - low), 0.0), 1.0)
    return Corners(before, after, level, level + 1, share, level_share)


@part
def wind_force(table: Table, instance: Instance, wind: UniformWind, n_coupled: int) -> None:
    """
    Find the modal forces of a uniform wind on a tree.

    Parameters
    ----------
    table
        Record of `table_layout`.
    instance
        Record of `instance_layout`. ``middle`` and ``middle_rate`` are the coordinates and their
        rates. Written are the forces, ``wanted``, and their slopes by the rate of the coordinate,
        ``diagonal``, which include those by the others, with equal rates.
    wind
        The wind.
    n_coupled
        Number of coordinates whose motion loads all; each of the others damps only itself.

    """
    fill_harmonics(wind.x, wind.y, wind.z, instance.values)
    corners = find_corners(table, wind.x, wind.y, instance.middle)
    steepness = max(0.0, (abs(wind.z) - STEEP) / (1.0 - STEEP))
    weights = _weights_of(corners, 1.0 - steepness)
    drag = _drag_per_speed(table, instance, wind)
    _begin(table, instance, corners, weights)
    _find_distances(table, instance, corners, weights)
    _add_harmonics(instance.values, table.harmonics, instance.wanted)
    _add_slopes(table, instance, corners, weights, _slants(corners, wind.z, steepness), n_coupled)
    _fill_diagonal(table, instance, corners, weights, drag)
    if steepness > 0.0:
        upwards = 1 if wind.z > 0.0 else 0
        _add_steep_slopes(table, instance, upwards, steepness, drag, n_coupled)
    _sum_up(table, instance, wind.dynamic_pressure, drag, n_coupled)
    _take_off_cross_damping(table, instance, corners, weights, drag)


@part
def _weights_of(corners: Corners, level_winds: float) -> Weights:
    """Find the weights of the corners, which add up to a share of winds that are not steep."""
    before = level_winds * (1.0 - corners.azimuth_share)
    after = level_winds * corners.azimuth_share
    up = corners.level_share
    return Weights(before * (1.0 - up), before * up, after * (1.0 - up), after * up)


@part
def _slants(corners: Corners, z: float, steepness: float) -> tuple[np.float32, np.float32]:
    """Find the weights of the change of slopes by the elevation, at the two azimuths."""
    slant = min(max(z, -STEEP), STEEP)
    before = (1.0 - steepness) * (1.0 - corners.azimuth_share)
    after = (1.0 - steepness) * corners.azimuth_share
    return np.float32(before * slant), np.float32(after * slant)


@part
def _begin(table: Table, instance: Instance, corners: Corners, weights: Weights) -> None:
    """Begin the forces with the interpolated load."""
    force, turned, damped = instance.wanted, instance.turned, instance.damped
    before, after, below, above = corners.before, corners.after, corners.below, corners.above
    for i in range(len(force)):
        force[i] = (
            weights.before_below * table.load[before, below, i]
            + weights.before_above * table.load[before, above, i]
            + weights.after_below * table.load[after, below, i]
            + weights.after_above * table.load[after, above, i]
        )
        turned[i] = damped[i] = 0.0


@part
def _find_distances(table: Table, instance: Instance, corners: Corners, weights: Weights) -> None:
    """Find how far the tree is from the poses at the corners, times their weights."""
    eta, distance = instance.middle, instance.distance
    before, after, below, above = corners.before, corners.after, corners.below, corners.above
    share, up = corners.azimuth_share, corners.level_share
    for i in range(len(eta)):
        low, other_low = table.equilibrium[before, below, i], table.equilibrium[after, below, i]
        step = table.equilibrium[before, above, i] - low
        other_step = table.equilibrium[after, above, i] - other_low
        away = eta[i] - (1.0 - share) * (low + up * step)
        away -= share * (other_low + up * other_step)
        # Half of the way to each pose, so that loads between levels are cubic.
        distance[0, i] = weights.before_below * (away + 0.5 * up * step)
        distance[1, i] = weights.before_above * (away - 0.5 * (1.0 - up) * step)
        distance[2, i] = weights.after_below * (away + 0.5 * up * other_step)
        distance[3, i] = weights.after_above * (away - 0.5 * (1.0 - up) * other_step)


@part
def _drag_per_speed(table: Table, instance: Instance, wind: UniformWind) -> float:
    """
    Find the drag per speed of the branches, ``p W`` in [kg/m^2/s].

    W is the root mean square of the wind and the velocity of the branches. Rates are kept in
    single precision for `_add_slopes`.
    """
    rate, single_rate = instance.middle_rate, instance.single_rate
    square = 0.0
    if wind.per_speed_squared > 0.0:
        square = wind.dynamic_pressure / wind.per_speed_squared
    for i in range(len(rate)):
        single_rate[i] = rate[i]
        square += table.motion[i] * rate[i] * rate[i]
    return wind.per_speed_squared * math.sqrt(square)


@part
def _add_harmonics(values: Floats, harmonics: Floats, force: Floats) -> None:
    """Add the load at rest, a sum of harmonics (h, m) by their values at the wind (h,)."""
    for k in range(len(values)):
        for i in range(len(force)):
            force[i] += values[k] * harmonics[k, i]


@part
def _add_slopes(
    table: Table, instance: Instance, corners: Corners, weights: Weights,
    slants: tuple[np.float32, np.float32], n_coupled: int,
) -> None:  # fmt: skip
    """
    Add the load by the distance from the corners, and the damping by the rates.

    The moving coordinate is the outer loop, so that the loop over the loaded ones is a vector.
    """
    eta, rates, distance = instance.middle, instance.single_rate, instance.distance
    turned, damped = instance.turned, instance.damped
    turning, damping, lean = table.turning, table.damping, table.lean
    before, after, below, above = corners.before, corners.after, corners.below, corners.above
    before_below = np.float32(weights.before_below)
    before_above = np.float32(weights.before_above)
    after_below = np.float32(weights.after_below)
    after_above = np.float32(weights.after_above)
    for k in range(n_coupled):
        away_0, away_1 = distance[0, k], distance[1, k]
        away_2, away_3 = distance[2, k], distance[3, k]
        rate_0, rate_1 = before_below * rates[k], before_above * rates[k]
        rate_2, rate_3 = after_below * rates[k], after_above * rates[k]
        moved = np.float32(eta[k])
        slant_before, slant_after = slants[0] * moved, slants[1] * moved
        for i in range(len(eta)):
            turned[i] += (
                away_0 * turning[before, below, k, i] + away_1 * turning[before, above, k, i]
                + away_2 * turning[after, below, k, i] + away_3 * turning[after, above, k, i]
                + slant_before * lean[before, k, i] + slant_after * lean[after, k, i]
            )  # fmt: skip
            damped[i] += (
                rate_0 * damping[before, below, k, i] + rate_1 * damping[before, above, k, i]
                + rate_2 * damping[after, below, k, i] + rate_3 * damping[after, above, k, i]
            )  # fmt: skip


@part
def _fill_diagonal(
    table: Table, instance: Instance, corners: Corners, weights: Weights, drag: float
) -> None:
    """Fill the slopes of the forces by the rate of the same coordinate."""
    diagonal, below, above = instance.diagonal, corners.below, corners.above
    before, after = corners.before, corners.after
    for i in range(len(diagonal)):
        diagonal[i] = drag * (
            weights.before_below * table.damping[before, below, i, i]
            + weights.before_above * table.damping[before, above, i, i]
            + weights.after_below * table.damping[after, below, i, i]
            + weights.after_above * table.damping[after, above, i, i]
        )


@part
def _add_steep_slopes(
    table: Table, instance: Instance, upwards: int, steepness: float, drag: float, n_coupled: int
) -> None:
    """Add the slopes in winds straight up or down, by the share that the wind has of them."""
    turned, damped, share = instance.turned, instance.damped, np.float32(steepness)
    for k in range(n_coupled):
        moved, rate = share * np.float32(instance.middle[k]), share * instance.single_rate[k]
        for i in range(len(turned)):
            turned[i] += moved * table.steep_turning[upwards, k, i]
            damped[i] += rate * table.steep_damping[upwards, k, i]
        instance.diagonal[k] += drag * steepness * table.steep_damping[upwards, k, k]


@part
def _sum_up(
    table: Table, instance: Instance, dynamic_pressure: float, drag: float, n_coupled: int
) -> None:
    """Sum the forces of load and damping."""
    force, turned, damped = instance.wanted, instance.turned, instance.damped
    limit, diagonal, rate = table.limit, instance.diagonal, instance.middle_rate
    for i in range(len(force)):
        # Slopes are valid near a pose; the load far from it is bounded by that of any wind.
        load = min(max(force[i] + turned[i], -limit[i]), limit[i])
        force[i] = dynamic_pressure * load + drag * damped[i]
    for i in range(n_coupled, len(force)):
        force[i] += diagonal[i] * rate[i]


@part
def _take_off_cross_damping(
    table: Table, instance: Instance, corners: Corners, weights: Weights, drag: float
) -> None:
    """Take the damping by the rates of the other coordinates off the slopes."""
    diagonal, below, above = instance.diagonal, corners.below, corners.above
    before, after = corners.before, corners.after
    for i in range(len(diagonal)):
        diagonal[i] -= drag * (
            weights.before_below * table.cross_damping[before, below, i]
            + weights.before_above * table.cross_damping[before, above, i]
            + weights.after_below * table.cross_damping[after, below, i]
            + weights.after_above * table.cross_damping[after, above, i]
        )
