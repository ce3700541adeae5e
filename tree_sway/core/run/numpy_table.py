# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A step of a tree on its table of winds in numpy: `table_model` without a compiler.

The formulas and the records are those of `table_load.wind_force` and
`table_model.step_instance`; a step is a few products of (m, m) matrices. Fields that the kernels
read in single precision are multiplied in single precision here too.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cached_property, partial
import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.arrays import Floats, Records, Singles
from tree_sway.core.model.drag_law import drag_density, DragLaw
from tree_sway.core.model.records import N_AZIMUTHS, N_LEVELS
from tree_sway.core.model.spherical_harmonics import fill_harmonics, N_HARMONICS
from tree_sway.core.run.table_load import STEEP
from tree_sway.core.run.table_model import MOMENTUM, MOST_PASSES, STRIDE, WindBasisBank

Views = Mapping[str, NDArray[Any]]
"""Fields of one record as arrays that share its memory; a number is an array of no axis."""


class NumpyTableBank(WindBasisBank):
    """`WindBasisBank` in numpy."""

    is_plain = True

    @cached_property
    def _step(self) -> Callable[..., int]:
        return partial(_advance, *self._views)

    def stepping(
        self, wind: Floats, max_wind: float, law: DragLaw
    ) -> Callable[[float, float, float], int]:
        """Return a step as one call, as `WindBasisBank.stepping`."""
        return partial(step_in_wind, *self._views, max_wind, law, wind)

    def rotations(self) -> Floats:
        """Key rotations in [rad], (N,)."""
        return self.rotations_of(self.instance)

    def rotations_of(self, instances: Records) -> Floats:
        """Key rotations in [rad], (N,), of a tree of this kind, as `placing.expand`."""
        shapes = self._single_shapes
        count = len(shapes) - int(instances['left_out'][0])
        shown = instances['eta'][0, :count] - instances['hidden'][0, :count]
        # In one order, whatever the number of threads of a matrix product.
        return np.einsum('m,mi->i', shown.astype(np.float32), shapes[:count]).astype(np.float64)

    @property
    def _views(self) -> tuple[Views, Views, Views]:
        return views_of(self.record), views_of(self.time_step), views_of(self.instance)

    @cached_property
    def _single_shapes(self) -> Singles:
        return self.all_shapes.astype(np.float32)


def views_of(records: Records, row: int = 0) -> dict[str, NDArray[Any]]:
    """Return the fields of one record as arrays that share its memory."""
    return {name: records[name][row, ...] for name in records.dtype.names or ()}


def wind_force(
    table: Views,
    direction: tuple[float, float, float],
    dynamic_pressure: float,
    per_speed_squared: float,
    eta: Floats,
    rate: Floats,
    n_coupled: int,
) -> tuple[Floats, Floats]:
    """
    Find the modal forces of a uniform wind, and their slopes by the rates.

    Parameters
    ----------
    table
        Views of a record of `table_layout`.
    direction
        Unit vector of the wind.
    dynamic_pressure, per_speed_squared
        Dynamic pressure ``p U^2`` in [kg/m/s^2] and p in [kg/m^3].
    eta, rate
        Coordinates and their rates, (m,).
    n_coupled
        Number of coordinates whose motion loads all; each of the others damps only itself.

    Returns
    -------
    tuple
        Modal forces, and their slopes by the rate of the coordinate, (m,), as in the kernel.

    """
    x, y, z = direction
    first, second, level, share, up = _located(table, x, y, eta)
    levels = slice(level, level + 2)
    steep = max(0.0, (abs(z) - STEEP) / (1.0 - STEEP))
    slant = min(max(z, -STEEP), STEEP)
    on_first = (1.0 - steep) * (1.0 - share)
    on_second = (1.0 - steep) * share
    at_first = np.array([on_first * (1.0 - up), on_first * up])
    at_second = np.array([on_second * (1.0 - up), on_second * up])

    def mean(values: NDArray[Any]) -> Any:
        """Interpolate a field (azimuths, levels, m) between the four corners."""
        return at_first @ values[first, levels] + at_second @ values[second, levels]

    poses = table['equilibrium'][first, levels]
    other_poses = table['equilibrium'][second, levels]
    apart = poses[1] - poses[0]
    other_apart = other_poses[1] - other_poses[0]
    away = eta - (1.0 - share) * (poses[0] + up * apart)
    away -= share * (other_poses[0] + up * other_apart)
    # Half of the way to each pose, so that loads between levels are cubic.
    half_way = np.array([[0.5 * up], [-0.5 * (1.0 - up)]])
    off = (at_first[:, None] * (away + half_way * apart)).astype(np.float32)
    other_off = (at_second[:, None] * (away + half_way * other_apart)).astype(np.float32)
    rates = rate.astype(np.float32)
    slow = eta.astype(np.float32)
    moving = rates.copy()
    for values in (off.T, other_off.T, moving, slow):
        values[n_coupled:] = 0.0

    turned = _product(off, table['turning'][first, levels])
    turned += _product(other_off, table['turning'][second, levels])
    turned += np.float32(on_first * slant) * slow @ table['lean'][first]
    turned += np.float32(on_second * slant) * slow @ table['lean'][second]
    single_first = at_first.astype(np.float32)
    single_second = at_second.astype(np.float32)
    damped = _product(single_first[:, None] * moving, table['damping'][first, levels])
    damped += _product(single_second[:, None] * moving, table['damping'][second, levels])

    speed_square = dynamic_pressure / per_speed_squared if per_speed_squared > 0.0 else 0.0
    drag = per_speed_squared * math.sqrt(speed_square + float(table['motion'] @ (rate * rate)))
    diagonal = drag * mean(np.diagonal(table['damping'], axis1=-2, axis2=-1))
    if steep > 0.0:
        pole = int(z > 0.0)
        weight = np.float32(steep)
        turned += weight * slow @ table['steep_turning'][pole]
        damped += weight * moving @ table['steep_damping'][pole]
        steep_diagonal = np.diagonal(table['steep_damping'][pole])
        diagonal[:n_coupled] += drag * steep * steep_diagonal[:n_coupled]
    # Slopes are valid near a pose; the load far from it is bounded by that of any wind.
    limit = table['limit']
    load = mean(table['load']) + harmonics(x, y, z) @ table['harmonics'] + turned
    force = dynamic_pressure * np.minimum(np.maximum(load, -limit), limit) + drag * damped
    force[n_coupled:] += diagonal[n_coupled:] * rate[n_coupled:]
    return force, diagonal - drag * mean(table['cross_damping'])


def _located(table: Views, x: float, y: float, eta: Floats) -> tuple[int, int, int, float, float]:
    """Locate a wind and a lean in a table, as `table_load.find_corners`."""
    turn = math.atan2(y, x) * (0.5 / math.pi) * N_AZIMUTHS
    whole = math.floor(turn)
    share = turn - whole
    first = whole % N_AZIMUTHS
    second = (first + 1) % N_AZIMUTHS
    amount = table['amount']
    levels = table['levels']
    lean = (1.0 - share) * float(amount[first] @ eta) + share * float(amount[second] @ eta)
    heights = ((1.0 - share) * levels[first] + share * levels[second]).tolist()
    level = 0
    while level < N_LEVELS - 2 and lean > heights[level + 1]:
        level += 1
    below = heights[level]
    above = heights[level + 1]
    up = min(max((lean - below) / (above - below), 0.0), 1.0)
    return first, second, level, share, up


def harmonics(x: float, y: float, z: float) -> Floats:
    """Return the harmonics (h,) at a direction, a unit vector."""
    values = [0.0] * N_HARMONICS
    _fill_harmonics(x, y, z, values)
    return np.array(values)


_fill_harmonics = fill_harmonics.py_func  # type: ignore[attr-defined]


def _product(amounts: Singles, slopes: Singles) -> Singles:
    """Sum slopes (k, m, m) by amounts (k, m) of the coordinate that moves, (m,)."""
    m = slopes.shape[-1]
    return np.asarray(amounts.reshape(-1) @ slopes.reshape(-1, m))


def step_instance(
    table: Views,
    time_step: Views,
    instance: Views,
    is_clamped: bool,
    wind: tuple[float, float, float],
    per_speed_squared: float,
) -> int:
    """Step one tree on its table, as `table_model.step_instance`."""
    x, y, z = wind
    speed = math.sqrt(x * x + y * y + z * z)
    direction = (x / speed, y / speed, z / speed) if speed > 0.0 else (1.0, 0.0, 0.0)
    most_pressure = float(table['most_pressure'])
    dynamic_pressure = per_speed_squared * speed * speed
    is_outside = not (is_clamped or dynamic_pressure <= most_pressure)
    dynamic_pressure = min(dynamic_pressure, most_pressure)
    eta = instance['eta']
    rate = instance['rate']
    force = instance['force']
    stiffness = table['stiffness']
    whole = time_step['whole']
    before = _energy(stiffness, eta, rate)
    wind_now = direction, dynamic_pressure, per_speed_squared
    wanted, own = _load_of_middle(table, time_step, instance, wind_now)
    # Implicit in all damping, with equal rates of the others: stable for any wind and step.
    new = (wanted - own * force) / (1.0 - own)
    change = new - force
    force[:] = new
    for _ in range(_more_passes(float(np.max(-own)))):
        wanted, own = _load_of_middle(table, time_step, instance, wind_now)
        change = STRIDE * (wanted - force) / (1.0 - own) + MOMENTUM * change
        force += change
    instance['wind'][:] = wind
    instance['drag_density'][...] = per_speed_squared
    moved = whole[0] * eta + whole[1] * rate + (whole[2] + whole[3]) * force
    rate[:] = whole[4] * eta + whole[5] * rate + (whole[6] + whole[7]) * force
    eta[:] = moved
    energy = _energy(stiffness, eta, rate)
    most = max(before, float(table['most_energy']))
    if not energy <= most:
        # A pull may bend it more than any wind; no wind adds to that.
        share = math.sqrt(most / energy)
        eta *= share
        rate *= share
        is_outside = True
    instance['outside'][...] = is_outside
    return int(is_outside)


def _more_passes(stiffest: float) -> int:
    """Return how many more passes the force of a step takes, as `table_model._more_passes`."""
    if not stiffest > 1.0:
        return 0
    return math.ceil(math.log2(min(stiffest, 2.0 ** (MOST_PASSES - 1))))


def _load_of_middle(
    table: Views, time_step: Views, instance: Views,
    wind: tuple[tuple[float, float, float], float, float],
) -> tuple[Floats, Floats]:  # fmt: skip
    """
    Go to the middle of the step under the force, and find the load of a wind there.

    The wind is direction, dynamic pressure and load per squared speed. Returns modal forces, and
    their slopes by the force of the coordinate, (m,).
    """
    eta = instance['eta']
    rate = instance['rate']
    force = instance['force']
    half = time_step['half']
    middle = instance['middle']
    middle_rate = instance['middle_rate']
    middle[:] = half[0] * eta + half[1] * rate + half[2] * force
    middle_rate[:] = half[3] * eta + half[4] * rate + half[5] * force
    n_coupled = int(table['n_modes']) - int(instance['left_out'])
    wanted, diagonal = wind_force(table, *wind, middle, middle_rate, n_coupled)
    instance['wanted'][:] = wanted
    instance['diagonal'][:] = diagonal
    return wanted, diagonal * half[5]


def _energy(stiffness: Floats, eta: Floats, rate: Floats) -> float:
    """Twice the strain and kinetic energy of coordinates [J]."""
    return float(stiffness @ (eta * eta) + rate @ rate)


def step_in_wind(
    table: Views,
    time_step: Views,
    instance: Views,
    max_wind: float,
    law: DragLaw,
    stored: Floats,
    x: float,
    y: float,
    z: float,
) -> int:
    """
    Check a wind [m/s] and step one tree, as `table_model.step_in_wind`.

    Returns the sum of 1 if the wind was refused, and 2 if it was clamped to the table's limit.
    """
    is_refused = not math.sqrt(x * x + y * y + z * z) <= max_wind
    if not is_refused:
        stored[:] = x, y, z
    wx, wy, wz = stored.tolist()
    load = drag_density(math.sqrt(wx * wx + wy * wy + wz * wz), *law)
    with np.errstate(all='ignore'):
        outside = step_instance(table, time_step, instance, False, (wx, wy, wz), load)
    return int(is_refused) + 2 * outside


def _advance(
    table: Views,
    time_step: Views,
    instance: Views,
    wx: float,
    wy: float,
    wz: float,
    per_speed_squared: float,
) -> int:
    with np.errstate(all='ignore'):
        return step_instance(table, time_step, instance, False, (wx, wy, wz), per_speed_squared)
