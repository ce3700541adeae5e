# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Gusts that reach the limbs of a tree one after another.

Models that step branches give each limb its own wind. `wind_basis` has uniform winds only. It
uses the mean of the limbs' winds, weighted by their loads, and adds the difference of load between
the wind of each delay and the mean, on the limbs of this delay of the tree at rest, reduced as the
load on the bent tree is.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.arrays import Floats
from tree_sway.core.kernel import entry_of, fused, part
from tree_sway.core.model.records import Instances, Table, Tables, TimeSteps
from tree_sway.core.model.spherical_harmonics import fill_harmonics
from tree_sway.core.model.sway_model import SwayModel
from tree_sway.core.run.numpy_table import harmonics, Views, views_of
from tree_sway.core.setup.numpy_branch_loads import into_slots
from tree_sway.core.wind.crown_wind import CrownWind


class CrownGusts:
    """The wind of a crown, and the model that is advanced in it."""

    def __init__(self, model: SwayModel, oscillators: Any, *, plain: bool = False) -> None:
        """Start without wind."""
        self._delay, self._share = model.limb_delay, model.limb_share
        self.wind = CrownWind(float(model.limb_spread[0]), model.settings.crown_coherence)
        self._oscillators = oscillators
        self._add_gusts: Callable[..., None] = add_gusts
        if oscillators.loads is None:
            moments = model.limb_harmonics
            arrays: tuple[NDArray[Any], ...] = (
                oscillators.record, oscillators.time_step, oscillators.instance, moments,
                self.wind.record['apart'][0], np.zeros((3, max(moments[0].shape))),
            )  # fmt: skip
            if plain:
                table, time_step, instance = (views_of(records) for records in arrays[:3])
                apart = self.wind.record['apart'][0]
                self._add_gusts = partial(
                    add_gusts_in_numpy, table, time_step, instance, moments, apart
                )
            else:
                self._add_gusts = partial(entry_of(add_gusts, *arrays, *[0.0] * 7), *arrays)

    def advance(self, x: float, y: float, z: float, per_speed_squared: float, dt: float) -> int:
        """Advance a step of dt [s] in a mean wind [m/s]; the result is that of the model."""
        apart, oscillators = self.wind.push(x, y, z, dt), self._oscillators
        if oscillators.loads is not None:
            into_slots(apart[self._delay], oscillators.loads['gust'])
            return int(oscillators.advance(x, y, z, per_speed_squared))
        ax, ay, az = (self._share @ apart).tolist()
        outcome = int(oscillators.advance(x + ax, y + ay, z + az, per_speed_squared))
        self._add_gusts(x, y, z, ax, ay, az, per_speed_squared)
        return outcome


@fused
def add_gusts(
    tables: Tables, time_steps: TimeSteps, instances: Instances, moments: Floats, apart: Floats,
    room: Floats, x: float, y: float, z: float, ax: float, ay: float, az: float,
    per_speed_squared: float,
) -> None:  # fmt: skip
    """
    Add to a step what the winds of the limbs of each delay do beside their mean.

    Parameters
    ----------
    tables, time_steps, instances
        Records, as in `step_instance`, the first of each.
    moments
        Harmonics of the loads on the limbs of each delay, (d, h, m).
    apart
        Wind of each delay less the wind in [m/s], (d, 3).
    room
        Scratch memory, (3, h or m, whichever is more).
    x, y, z, ax, ay, az
        The wind, and the mean of the winds of the limbs less the wind in [m/s].
    per_speed_squared
        `drag_law.pressure` in [kg/m^3].

    """
    table, whole, half = tables[0], time_steps[0].whole, time_steps[0].half
    instance, mean, own, force = instances[0], room[0], room[1], room[2]
    _load(table, x + ax, y + ay, z + az, per_speed_squared, mean)
    force[:] = 0.0
    for delay in range(len(moments)):
        more = apart[delay]
        _load(table, x + more[0], y + more[1], z + more[2], per_speed_squared, own)
        for k in range(moments.shape[1]):
            change = own[k] - mean[k]
            for i in range(moments.shape[2]):
                force[i] += change * moments[delay, k, i]
    bent, upright = 0.0, 1e-300
    for i in range(moments.shape[2]):
        at_rest = 0.0
        for k in range(moments.shape[1]):
            at_rest += mean[k] * table.harmonics[k, i]
        bent += at_rest * instance.wanted[i] / table.stiffness[i]
        upright += at_rest * at_rest / table.stiffness[i]
    share = min(max(bent / upright, 0.0), 1.0)
    for i in range(moments.shape[2]):
        # As in `step_instance`.
        added = share * force[i] / (1.0 - instance.diagonal[i] * half[5, i])
        instance.eta[i] += (whole[2, i] + whole[3, i]) * added
        instance.rate[i] += (whole[6, i] + whole[7, i]) * added
        instance.force[i] += added


def add_gusts_in_numpy(
    table: Views, time_step: Views, instance: Views, moments: Floats, apart: Floats,
    x: float, y: float, z: float, ax: float, ay: float, az: float, per_speed_squared: float,
) -> None:  # fmt: skip
    """Add to a step what the winds of the limbs do beside their mean, as `add_gusts`."""
    m = moments.shape[2]
    most_pressure = float(table['most_pressure'])

    def load(wx: float, wy: float, wz: float) -> Floats:
        """Harmonics (h,) of a wind [m/s] times its dynamic pressure."""
        speed = max(math.sqrt(wx * wx + wy * wy + wz * wz), 1e-12)
        dynamic_pressure = min(per_speed_squared * speed * speed, most_pressure)
        return dynamic_pressure * harmonics(wx / speed, wy / speed, wz / speed)

    mean = load(x + ax, y + ay, z + az)
    force = np.zeros(m)
    for (more_x, more_y, more_z), by_harmonics in zip(apart.tolist(), moments, strict=True):
        force += (load(x + more_x, y + more_y, z + more_z) - mean) @ by_harmonics
    at_rest = mean @ table['harmonics'][:, :m] / table['stiffness'][:m]
    bent = float(at_rest @ instance['wanted'][:m])
    upright = 1e-300 + float(at_rest @ (at_rest * table['stiffness'][:m]))
    whole, half = time_step['whole'][:, :m], time_step['half'][:, :m]
    # As in `step_instance`.
    added = min(max(bent / upright, 0.0), 1.0) * force
    added /= 1.0 - instance['diagonal'][:m] * half[5]
    instance['eta'][:m] += (whole[2] + whole[3]) * added
    instance['rate'][:m] += (whole[6] + whole[7]) * added
    instance['force'][:m] += added


@part
def _load(table: Table, x: float, y: float, z: float, per_speed: float, out: Floats) -> None:
    """Write the harmonics of a wind [m/s] times its dynamic pressure, by `drag_law.pressure`."""
    speed = max(math.sqrt(x * x + y * y + z * z), 1e-12)
    pressure = min(per_speed * speed * speed, table.most_pressure)
    fill_harmonics(x / speed, y / speed, z / speed, out)
    for k in range(len(out)):
        out[k] *= pressure
