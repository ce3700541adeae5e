# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Modal forces of a uniform wind from the table of a tree."""

from __future__ import annotations

import math

import numpy as np

from tree_sway.core.arrays import Floats, Singles
from tree_sway.core.kernel import part
from tree_sway.core.model.records import N_AZIMUTHS, N_LEVELS, Table
from tree_sway.core.model.spherical_harmonics import fill_harmonics

STEEP = math.sin(math.radians(45.0))
"""Sine of the elevation above which slopes are blended with those of vertical wind."""


@part
def table_corners(
    table: Table, x: float, y: float, eta: Floats
) -> tuple[int, int, int, float, float]:
    """
    Locate a wind and a lean in a table.

    Returns
    -------
    tuple
        Azimuths before and after, level below, and shares of the way to the next azimuth and to
        the next level.

    """
    turn = math.atan2(y, x) * (0.5 / math.pi) * N_AZIMUTHS
    whole = math.floor(turn)
    share = turn - whole
    first = int(whole) % N_AZIMUTHS
    second = (first + 1) % N_AZIMUTHS
    rest = 1.0 - share
    lean = 0.0
    for i in range(len(eta)):
        lean += (rest * table.amount[first, i] + share * table.amount[second, i]) * eta[i]
    j = 0
    below = rest * table.levels[first, 0] + share * table.levels[second, 0]
    above = rest * table.levels[first, 1] + share * table.levels[second, 1]
    while j < N_LEVELS - 2 and lean > above:
        j += 1
        below = above
        above = rest * table.levels[first, j + 1] + share * table.levels[second, j + 1]
    up = min(max((lean - below) / (above - below), 0.0), 1.0)
    return first, second, j, share, up


@part
def wind_force(
    table: Table, x: float, y: float, z: float, dynamic_pressure: float, per_speed_squared: float,
    eta: Floats, rate: Floats, values: Floats, scratch: Singles, force: Floats, diagonal: Floats,
    n_coupled: int,
) -> None:  # fmt: skip
    """
    Find the modal forces of a uniform wind.

    Parameters
    ----------
    table
        Record of `table_layout`.
    x, y, z
        Unit vector of the wind.
    dynamic_pressure, per_speed_squared
        Dynamic pressure ``p U^2`` in [kg/m/s^2] and p in [kg/m^3].
    eta, rate
        Coordinates and their rates, (m,).
    values, scratch
        Harmonics, (h,), and scratch memory in single precision, (7, m), both written.
    force, diagonal
        Modal forces, and their slopes by the rate of the coordinate, (m,), both written; the
        slopes include those by the others, with equal rates.
    n_coupled
        Number of coordinates whose motion loads all; each of the others damps only itself.

    """
    m = len(eta)
    fill_harmonics(x, y, z, values)
    first, second, j, share, up = table_corners(table, x, y, eta)
    steep = max(0.0, (abs(z) - STEEP) / (1.0 - STEEP))
    level, slant, pole = 1.0 - steep, min(max(z, -STEEP), STEEP), 1 if z > 0.0 else 0
    e, f = level * (1.0 - share), level * share
    a, b, c, d = e * (1.0 - up), e * up, f * (1.0 - up), f * up
    turned, damped, rates, off = scratch[0], scratch[1], scratch[2], scratch[3:]
    moving = dynamic_pressure / per_speed_squared if per_speed_squared > 0.0 else 0.0
    for i in range(m):
        on = table.equilibrium[first, j + 1, i] - table.equilibrium[first, j, i]
        by = table.equilibrium[second, j + 1, i] - table.equilibrium[second, j, i]
        away = eta[i] - (1.0 - share) * (table.equilibrium[first, j, i] + up * on)
        away -= share * (table.equilibrium[second, j, i] + up * by)
        # Half of the way to each pose, so that loads between levels are cubic.
        off[0, i] = a * (away + 0.5 * up * on)
        off[1, i] = b * (away - 0.5 * (1.0 - up) * on)
        off[2, i] = c * (away + 0.5 * up * by)
        off[3, i] = d * (away - 0.5 * (1.0 - up) * by)
        rates[i] = rate[i]
        moving += table.motion[i] * rate[i] * rate[i]
        force[i] = (
            a * table.load[first, j, i] + b * table.load[first, j + 1, i]
            + c * table.load[second, j, i] + d * table.load[second, j + 1, i]
        )  # fmt: skip
        turned[i] = damped[i] = 0.0
    drag = per_speed_squared * math.sqrt(moving)
    for k in range(len(values)):
        for i in range(m):
            force[i] += values[k] * table.harmonics[k, i]
    a4, b4, c4, d4 = np.float32(a), np.float32(b), np.float32(c), np.float32(d)
    e4, f4 = np.float32(e * slant), np.float32(f * slant)
    for k in range(n_coupled):
        moving_at, slow = rates[k], np.float32(eta[k])
        am, bm, cm, dm = off[0, k], off[1, k], off[2, k], off[3, k]
        av, bv, cv, dv = a4 * moving_at, b4 * moving_at, c4 * moving_at, d4 * moving_at
        em, fm = e4 * slow, f4 * slow
        for i in range(m):
            turned[i] += (
                am * table.turning[first, j, k, i] + bm * table.turning[first, j + 1, k, i]
                + cm * table.turning[second, j, k, i] + dm * table.turning[second, j + 1, k, i]
                + em * table.lean[first, k, i] + fm * table.lean[second, k, i]
            )  # fmt: skip
            damped[i] += (
                av * table.damping[first, j, k, i] + bv * table.damping[first, j + 1, k, i]
                + cv * table.damping[second, j, k, i] + dv * table.damping[second, j + 1, k, i]
            )  # fmt: skip
    for i in range(m):
        diagonal[i] = drag * (
            a * table.damping[first, j, i, i] + b * table.damping[first, j + 1, i, i]
            + c * table.damping[second, j, i, i] + d * table.damping[second, j + 1, i, i]
        )  # fmt: skip
    if steep > 0.0:
        s4 = np.float32(steep)
        for k in range(n_coupled):
            moved, moving_at = s4 * np.float32(eta[k]), s4 * rates[k]
            for i in range(m):
                turned[i] += moved * table.steep_turning[pole, k, i]
                damped[i] += moving_at * table.steep_damping[pole, k, i]
            diagonal[k] += drag * steep * table.steep_damping[pole, k, k]
    for i in range(m):
        # Slopes are valid near a pose; the load far from it is bounded by that of any wind.
        load = min(max(force[i] + turned[i], -table.limit[i]), table.limit[i])
        force[i] = dynamic_pressure * load + drag * damped[i]
    for i in range(n_coupled, m):
        force[i] += diagonal[i] * rate[i]
    for i in range(m):
        diagonal[i] -= drag * (
            a * table.cross_damping[first, j, i] + b * table.cross_damping[first, j + 1, i]
            + c * table.cross_damping[second, j, i] + d * table.cross_damping[second, j + 1, i]
        )  # fmt: skip
