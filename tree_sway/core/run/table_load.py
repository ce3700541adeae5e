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
    """`drag_law.drag_density` p in [kg/m^3]."""


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
    for mode in range(len(eta)):
        amount = rest * table.amount[before, mode] + share * table.amount[after, mode]
        lean += amount * eta[mode]
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
    below = 1.0 - corners.level_share
    above = corners.level_share
    return Weights(before * below, before * above, after * below, after * above)


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
    force = instance.wanted
    turned = instance.turned
    damped = instance.damped
    for mode in range(len(force)):
        force[mode] = _between(table.load, corners, weights, mode)
        turned[mode] = damped[mode] = 0.0


@part
def _between(values: Floats, corners: Corners, weights: Weights, mode: int) -> float:
    """Interpolate a value of a coordinate between the corners."""
    before = corners.before
    after = corners.after
    below = corners.below
    above = corners.above
    return float(
        weights.before_below * values[before, below, mode]
        + weights.before_above * values[before, above, mode]
        + weights.after_below * values[after, below, mode]
        + weights.after_above * values[after, above, mode]
    )


@part
def _find_distances(table: Table, instance: Instance, corners: Corners, weights: Weights) -> None:
    """Find how far the tree is from the poses at the corners, times their weights."""
    eta = instance.middle
    distance = instance.distance
    before = corners.before
    after = corners.after
    below = corners.below
    above = corners.above
    share = corners.azimuth_share
    above_share = corners.level_share
    for mode in range(len(eta)):
        low = table.equilibrium[before, below, mode]
        other_low = table.equilibrium[after, below, mode]
        step = table.equilibrium[before, above, mode] - low
        other_step = table.equilibrium[after, above, mode] - other_low
        away = eta[mode] - (1.0 - share) * (low + above_share * step)
        away -= share * (other_low + above_share * other_step)
        # Half of the way to each pose, so that loads between levels are cubic.
        to_below = 0.5 * above_share
        to_above = 0.5 * (1.0 - above_share)
        distance[0, mode] = weights.before_below * (away + to_below * step)
        distance[1, mode] = weights.before_above * (away - to_above * step)
        distance[2, mode] = weights.after_below * (away + to_below * other_step)
        distance[3, mode] = weights.after_above * (away - to_above * other_step)


@part
def _drag_per_speed(table: Table, instance: Instance, wind: UniformWind) -> float:
    """
    Find the drag per speed of the branches, ``p W`` in [kg/m^2/s].

    W is the root mean square of the wind and the velocity of the branches. Rates are kept in
    single precision for `_add_slopes`.
    """
    rate = instance.middle_rate
    single_rate = instance.single_rate
    square = 0.0
    if wind.per_speed_squared > 0.0:
        square = wind.dynamic_pressure / wind.per_speed_squared
    for mode in range(len(rate)):
        single_rate[mode] = rate[mode]
        square += table.motion[mode] * rate[mode] * rate[mode]
    return wind.per_speed_squared * math.sqrt(square)


@part
def _add_harmonics(values: Floats, harmonics: Floats, force: Floats) -> None:
    """Add the load at rest, a sum of harmonics (h, m) by their values at the wind (h,)."""
    for number in range(len(values)):
        for mode in range(len(force)):
            force[mode] += values[number] * harmonics[number, mode]


@part
def _add_slopes(
    table: Table, instance: Instance, corners: Corners, weights: Weights,
    slants: tuple[np.float32, np.float32], n_coupled: int,
) -> None:  # fmt: skip
    """
    Add the load by the distance from the corners, and the damping by the rates.

    The moving coordinate is the outer loop, so that the loop over the loaded ones is a vector.
    """
    eta = instance.middle
    rates = instance.single_rate
    distance = instance.distance
    turned = instance.turned
    damped = instance.damped
    turning = table.turning
    damping = table.damping
    lean = table.lean
    before = corners.before
    after = corners.after
    below = corners.below
    above = corners.above
    before_below = np.float32(weights.before_below)
    before_above = np.float32(weights.before_above)
    after_below = np.float32(weights.after_below)
    after_above = np.float32(weights.after_above)
    for moving in range(n_coupled):
        away_0 = distance[0, moving]
        away_1 = distance[1, moving]
        away_2 = distance[2, moving]
        away_3 = distance[3, moving]
        rate_0 = before_below * rates[moving]
        rate_1 = before_above * rates[moving]
        rate_2 = after_below * rates[moving]
        rate_3 = after_above * rates[moving]
        moved = np.float32(eta[moving])
        slant_before = slants[0] * moved
        slant_after = slants[1] * moved
        for mode in range(len(eta)):
            turned[mode] += (
                away_0 * turning[before, below, moving, mode]
                + away_1 * turning[before, above, moving, mode]
                + away_2 * turning[after, below, moving, mode]
                + away_3 * turning[after, above, moving, mode]
                + slant_before * lean[before, moving, mode]
                + slant_after * lean[after, moving, mode]
            )
            damped[mode] += (
                rate_0 * damping[before, below, moving, mode]
                + rate_1 * damping[before, above, moving, mode]
                + rate_2 * damping[after, below, moving, mode]
                + rate_3 * damping[after, above, moving, mode]
            )


@part
def _fill_diagonal(
    table: Table, instance: Instance, corners: Corners, weights: Weights, drag: float
) -> None:
    """Fill the slopes of the forces by the rate of the same coordinate."""
    diagonal = instance.diagonal
    below = corners.below
    above = corners.above
    before = corners.before
    after = corners.after
    for mode in range(len(diagonal)):
        diagonal[mode] = drag * (
            weights.before_below * table.damping[before, below, mode, mode]
            + weights.before_above * table.damping[before, above, mode, mode]
            + weights.after_below * table.damping[after, below, mode, mode]
            + weights.after_above * table.damping[after, above, mode, mode]
        )


@part
def _add_steep_slopes(
    table: Table, instance: Instance, upwards: int, steepness: float, drag: float, n_coupled: int
) -> None:
    """Add the slopes in winds straight up or down, by the share that the wind has of them."""
    turned = instance.turned
    damped = instance.damped
    share = np.float32(steepness)
    for moving in range(n_coupled):
        moved = share * np.float32(instance.middle[moving])
        rate = share * instance.single_rate[moving]
        for mode in range(len(turned)):
            turned[mode] += moved * table.steep_turning[upwards, moving, mode]
            damped[mode] += rate * table.steep_damping[upwards, moving, mode]
        instance.diagonal[moving] += (
            drag * steepness * table.steep_damping[upwards, moving, moving]
        )


@part
def _sum_up(
    table: Table, instance: Instance, dynamic_pressure: float, drag: float, n_coupled: int
) -> None:
    """Sum the forces of load and damping."""
    force = instance.wanted
    turned = instance.turned
    damped = instance.damped
    limit = table.limit
    diagonal = instance.diagonal
    rate = instance.middle_rate
    for mode in range(len(force)):
        # Slopes are valid near a pose; the load far from it is bounded by that of any wind.
        load = min(max(force[mode] + turned[mode], -limit[mode]), limit[mode])
        force[mode] = dynamic_pressure * load + drag * damped[mode]
    for mode in range(n_coupled, len(force)):
        force[mode] += diagonal[mode] * rate[mode]


@part
def _take_off_cross_damping(
    table: Table, instance: Instance, corners: Corners, weights: Weights, drag: float
) -> None:
    """Take the damping by the rates of the other coordinates off the slopes."""
    diagonal = instance.diagonal
    for mode in range(len(diagonal)):
        diagonal[mode] -= drag * _between(table.cross_damping, corners, weights, mode)
