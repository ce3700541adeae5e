# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Gusts that reach the limbs of a tree one after another.

Models that step branches give each limb its own wind, and so does the step of a limp tree at its
pose. The table of `table_model` has uniform winds
only: it is read at the mean of the limbs' winds, weighted by their loads. Then the difference of
load between the wind of each delay and the mean is added for the limbs of this delay. It is found
on the tree at rest and reduced as the load on the bent tree is.
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
from tree_sway.core.run.limp_tree import LimpBank
from tree_sway.core.run.numpy_table import harmonics, Views, views_of
from tree_sway.core.setup.numpy_branch_loads import into_slots
from tree_sway.core.wind.crown_wind import CrownWind

_TINY = 1e-300
"""Added to a sum of squares that is divided by."""


class CrownGusts:
    """The wind of a crown, and the model that is advanced in it."""

    def __init__(self, model: SwayModel, oscillators: Any, *, plain: bool = False) -> None:
        """Start without wind."""
        self._delay = model.limb_delay
        self._share = model.limb_share
        self.wind = CrownWind(float(model.limb_spread[0]), model.settings.crown_coherence)
        self._oscillators = oscillators
        if oscillators.loads is None:
            self._add_gusts = self._bound(model.limb_harmonics, plain=plain)

    def _bound(self, moments: Floats, *, plain: bool) -> Callable[..., None]:
        """Return `add_gusts`, or its numpy form, with the arrays of the model."""
        oscillators = self._oscillators
        apart = self.wind.record['apart'][0]
        records = oscillators.record, oscillators.time_step, oscillators.instance
        if plain:
            table, time_step, instance = (views_of(each) for each in records)
            return partial(add_gusts_in_numpy, table, time_step, instance, moments, apart)
        scratch = np.zeros((3, max(moments[0].shape)))
        arrays: tuple[NDArray[Any], ...] = *records, moments, apart, scratch
        return partial(entry_of(add_gusts, *arrays, *[0.0] * 7), *arrays)

    def advance(self, x: float, y: float, z: float, per_speed_squared: float, dt: float) -> int:
        """Advance a step of dt [s] in a mean wind [m/s]; the result is that of the model."""
        oscillators = self._oscillators
        apart = self.wind.push(x, y, z, dt)
        if oscillators.loads is not None:
            into_slots(apart[self._delay], oscillators.loads['gust'])
            return int(oscillators.advance(x, y, z, per_speed_squared))
        if isinstance(oscillators, LimpBank) and oscillators.takes_gusts(apart[self._delay]):
            return int(oscillators.advance(x, y, z, per_speed_squared))
        mean = (self._share @ apart).tolist()
        in_mean = x + mean[0], y + mean[1], z + mean[2]
        outcome = int(oscillators.advance(*in_mean, per_speed_squared))
        self._add_gusts(x, y, z, *mean, per_speed_squared)
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
        `drag_law.drag_density` in [kg/m^3].

    """
    table = tables[0]
    instance = instances[0]
    time_step = time_steps[0]
    mean = room[0]
    own = room[1]
    force = room[2]
    n_harmonics = moments.shape[1]
    n_modes = moments.shape[2]
    _load(table, x + ax, y + ay, z + az, per_speed_squared, mean)
    force[:] = 0.0
    for delay in range(len(moments)):
        more = apart[delay]
        _load(table, x + more[0], y + more[1], z + more[2], per_speed_squared, own)
        for number in range(n_harmonics):
            change = own[number] - mean[number]
            for mode in range(n_modes):
                force[mode] += change * moments[delay, number, mode]
    bent = 0.0
    upright = _TINY
    for mode in range(n_modes):
        at_rest = 0.0
        for number in range(n_harmonics):
            at_rest += mean[number] * table.harmonics[number, mode]
        bent += at_rest * instance.wanted[mode] / table.stiffness[mode]
        upright += at_rest * at_rest / table.stiffness[mode]
    share = min(max(bent / upright, 0.0), 1.0)
    whole = time_step.whole
    for mode in range(n_modes):
        # As in `step_instance`.
        implicit = 1.0 - instance.diagonal[mode] * time_step.half[5, mode]
        added = share * force[mode] / implicit
        instance.eta[mode] += (whole[2, mode] + whole[3, mode]) * added
        instance.rate[mode] += (whole[6, mode] + whole[7, mode]) * added
        instance.force[mode] += added


def add_gusts_in_numpy(
    table: Views, time_step: Views, instance: Views, moments: Floats, apart: Floats,
    x: float, y: float, z: float, ax: float, ay: float, az: float, per_speed_squared: float,
) -> None:  # fmt: skip
    """Add to a step what the winds of the limbs do beside their mean, as `add_gusts`."""
    most_pressure = float(table['most_pressure'])

    def load(wx: float, wy: float, wz: float) -> Floats:
        """Harmonics (h,) of a wind [m/s] times its dynamic pressure."""
        speed = max(math.sqrt(wx * wx + wy * wy + wz * wz), 1e-12)
        dynamic_pressure = min(per_speed_squared * speed * speed, most_pressure)
        return dynamic_pressure * harmonics(wx / speed, wy / speed, wz / speed)

    mean = load(x + ax, y + ay, z + az)
    n_modes = moments.shape[2]
    force = np.zeros(n_modes)
    for (more_x, more_y, more_z), by_harmonics in zip(apart.tolist(), moments, strict=True):
        own = load(x + more_x, y + more_y, z + more_z)
        force += (own - mean) @ by_harmonics
    stiffness = table['stiffness'][:n_modes]
    at_rest = mean @ table['harmonics'][:, :n_modes]
    static = at_rest / stiffness
    bent = float(static @ instance['wanted'][:n_modes])
    upright = _TINY + float(static @ at_rest)
    share = min(max(bent / upright, 0.0), 1.0)
    whole = time_step['whole'][:, :n_modes]
    # As in `step_instance`.
    implicit = 1.0 - instance['diagonal'][:n_modes] * time_step['half'][5, :n_modes]
    added = share * force / implicit
    instance['eta'][:n_modes] += (whole[2] + whole[3]) * added
    instance['rate'][:n_modes] += (whole[6] + whole[7]) * added
    instance['force'][:n_modes] += added


@part
def _load(table: Table, x: float, y: float, z: float, per_speed: float, out: Floats) -> None:
    """Write the harmonics of a wind [m/s] times its dynamic pressure."""
    speed = max(math.sqrt(x * x + y * y + z * z), 1e-12)
    pressure = min(per_speed * speed * speed, table.most_pressure)
    fill_harmonics(x / speed, y / speed, z / speed, out)
    for number in range(len(out)):
        out[number] *= pressure
