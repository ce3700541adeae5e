# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Modal forces of an even wind, out of the table of a tree."""

from __future__ import annotations

from functools import cache
import math

import numpy as np

from tree_sway_ros.core.arrays import Floats, Record
from tree_sway_ros.core.kernel import fused, inlined
from tree_sway_ros.core.motion.harmonics import fill_harmonics

N_AZIMUTHS, N_LEVELS, N_REST = 24, 5, 16
"""Azimuths of the wind and levels of the lean in the table, and shapes of the static rest."""

_MODES_TOGETHER = 4
_LEAST_MODES = 20


@cache
def table_layout(n_modes: int, n_harmonics: int) -> np.dtype[np.void]:
    """
    Table of one tree; modes are filled up to a multiple of four, at least twenty.

    One layout serves most trees, so that the kernel is compiled once.
    """
    m = max(_LEAST_MODES, -(-n_modes // _MODES_TOGETHER) * _MODES_TOGETHER)
    a, n = N_AZIMUTHS, N_LEVELS
    return np.dtype(
        [
            ('n_modes', 'i8'),
            ('degree', 'i8'),
            ('levels', 'f8', (n,)),  # dynamic pressures [kg/m/s^2]
            ('most_pressure', 'f8'),  # up to which the table holds [kg/m/s^2]
            ('most_energy', 'f8'),  # twice the strain energy up to which it holds [J]
            ('stiffness', 'f8', (m,)),
            ('harmonics', 'f8', (n_harmonics, m)),
            ('rest_harmonics', 'f8', (n_harmonics, N_REST)),
            ('static', 'f8', (a, m)),  # deflection per dynamic pressure
            ('amount', 'f8', (a, m)),  # weights of the modes in the lean along it
            ('excess', 'f8', (a, m)),
            ('lean', 'f8', (a, m, m)),  # as the next ones: by the mode that moves, then the mode
            ('load', 'f8', (a, n, m)),
            ('rest', 'f8', (a, n, N_REST)),
            ('rest_turning', 'f8', (a, m, N_REST)),
            ('rest_damping', 'f8', (a, m, N_REST)),
            ('turning', 'f8', (a, n, m, m)),
            ('damping', 'f8', (a, n, m, m)),
        ]
    )


@cache
def pace_layout(n_modes: int) -> np.dtype[np.void]:
    """How the modes of a table go on in a time step."""
    m = table_layout(n_modes, 0)['stiffness'].shape[0]
    return np.dtype(
        [
            ('whole', 'f8', (8, m)),  # columns of the propagator of a step
            ('half', 'f8', (6, m)),  # of half a step under a constant load
        ]
    )


@inlined
def table_corners(
    table: Record, x: float, y: float, eta: Floats
) -> tuple[int, int, int, float, float, float]:
    """
    Where a wind and a lean are in a table.

    Returns
    -------
    tuple
        Azimuths before and after, level below, shares of the way to the next azimuth and to the
        next level, and the lean as the dynamic pressure that would hold it in [kg/m/s^2].

    """
    turn = math.atan2(y, x) * (0.5 / math.pi) * N_AZIMUTHS
    whole = math.floor(turn)
    share = turn - whole
    first = int(whole) % N_AZIMUTHS
    second = (first + 1) % N_AZIMUTHS
    lean = 0.0
    for i in range(len(eta)):
        weight = (1.0 - share) * table.amount[first, i] + share * table.amount[second, i]
        lean += weight * eta[i]
    j = 0
    while j < N_LEVELS - 2 and lean > table.levels[j + 1]:
        j += 1
    up = (lean - table.levels[j]) / (table.levels[j + 1] - table.levels[j])
    return first, second, j, share, up, lean


@fused
def wind_force(
    table: Record, x: float, y: float, z: float, push: float, drag: float,
    eta: Floats, rate: Floats, values: Floats, scratch: Floats, force: Floats,
) -> None:  # fmt: skip
    """
    Find the modal forces of an even wind.

    Parameters
    ----------
    table
        Record of `table_layout`.
    x, y, z
        Where the wind goes, a unit vector.
    push, drag
        Dynamic pressure ``p U^2`` in [kg/m/s^2] and ``p U`` in [kg/m^2/s].
    eta, rate
        Modes and their rates, (m,).
    values, scratch
        Harmonics, (h,), written; and to work in, (3, m), the last of these gets the diagonal of
        the damping.
    force
        Modal forces (m,), written.

    """
    m = len(eta)
    fill_harmonics(x, y, z, table.degree, values)
    first, second, j, share, up, lean = table_corners(table, x, y, eta)
    a, b, c, d = (1.0 - share) * (1.0 - up), (1.0 - share) * up, share * (1.0 - up), share * up
    off, damp, diagonal = scratch[0], scratch[1], scratch[2]
    for i in range(m):
        static = (1.0 - share) * table.static[first, i] + share * table.static[second, i]
        off[i] = eta[i] - lean * static
        excess = (1.0 - share) * table.excess[first, i] + share * table.excess[second, i]
        force[i] = (
            a * table.load[first, j, i] + b * table.load[first, j + 1, i]
            + c * table.load[second, j, i] + d * table.load[second, j + 1, i]
            + (push - lean) * excess
        )  # fmt: skip
        damp[i] = 0.0
    for k in range(len(values)):
        for i in range(m):
            force[i] += values[k] * table.harmonics[k, i]
    for k in range(m):
        moved, slant, pace = off[k], z * eta[k], rate[k]
        for i in range(m):
            force[i] += moved * (
                a * table.turning[first, j, k, i] + b * table.turning[first, j + 1, k, i]
                + c * table.turning[second, j, k, i] + d * table.turning[second, j + 1, k, i]
            ) + slant * (
                (1.0 - share) * table.lean[first, k, i] + share * table.lean[second, k, i]
            )  # fmt: skip
            damp[i] += pace * (
                a * table.damping[first, j, k, i] + b * table.damping[first, j + 1, k, i]
                + c * table.damping[second, j, k, i] + d * table.damping[second, j + 1, k, i]
            )  # fmt: skip
    for i in range(m):
        force[i] = push * force[i] + drag * damp[i]
        diagonal[i] = drag * (
            a * table.damping[first, j, i, i] + b * table.damping[first, j + 1, i, i]
            + c * table.damping[second, j, i, i] + d * table.damping[second, j + 1, i, i]
        )  # fmt: skip


@fused
def wind_rest(
    table: Record, x: float, y: float, push: float, drag: float,
    eta: Floats, rate: Floats, values: Floats, rest: Floats,
) -> None:  # fmt: skip
    """Find the static rest of modes left out, (r,), as `wind_force`, by wind harmonics (h,)."""
    first, second, j, share, up, lean = table_corners(table, x, y, eta)
    a, b, c, d = (1.0 - share) * (1.0 - up), (1.0 - share) * up, share * (1.0 - up), share * up
    for r in range(len(rest)):
        rest[r] = push * (
            a * table.rest[first, j, r] + b * table.rest[first, j + 1, r]
            + c * table.rest[second, j, r] + d * table.rest[second, j + 1, r]
        )  # fmt: skip
    for k in range(len(values)):
        for r in range(len(rest)):
            rest[r] += push * values[k] * table.rest_harmonics[k, r]
    for k in range(len(eta)):
        static = (1.0 - share) * table.static[first, k] + share * table.static[second, k]
        moved, pace = push * (eta[k] - lean * static), drag * rate[k]
        for r in range(len(rest)):
            rest[r] += (1.0 - share) * (
                moved * table.rest_turning[first, k, r] + pace * table.rest_damping[first, k, r]
            ) + share * (
                moved * table.rest_turning[second, k, r] + pace * table.rest_damping[second, k, r]
            )
