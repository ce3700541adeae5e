# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Steps of a stand in numpy, tree after tree: `stand.step_stand` without a compiler."""

from __future__ import annotations

import math

import numpy as np

from tree_sway.core.arrays import Floats, Records
from tree_sway.core.model.drag_law import drag_density
from tree_sway.core.run.numpy_table import step_instance, Views, views_of

_STATE = 'eta', 'rate', 'force', 'middle', 'middle_rate'


def step_stand(
    tables: Records,
    time_steps: Records,
    placements: Records,
    instances: Records,
    drag_laws: Floats,
    winds: Floats,
) -> tuple[int, int]:
    """Step every tree that is not still, as `stand.step_stand`."""
    kinds = [views_of(tables, row) for row in range(len(tables))]
    steps = [views_of(time_steps, row) for row in range(len(time_steps))]
    n_clamped = n_restarted = 0
    for number in np.flatnonzero(placements['is_still'] == 0).tolist():
        here = placements[number]
        kind = int(placements['kind'][number])
        wind, load, is_clamped = _own_wind(here, winds[number], kinds[kind], drag_laws[kind])
        placements['is_clamped'][number] = is_clamped
        instance = views_of(instances, number)
        step = steps[int(here['time_step'])]
        with np.errstate(all='ignore'):
            is_outside = step_instance(kinds[kind], step, instance, is_clamped, wind, load)
        n_clamped += is_clamped or is_outside
        if not (np.isfinite(instance['eta']).all() and np.isfinite(instance['rate']).all()):
            n_restarted += 1
            for name in _STATE:
                instance[name][:] = 0.0
    return n_clamped, n_restarted


def _own_wind(
    here: np.void, wind: Floats, table: Views, drag_law: Floats
) -> tuple[tuple[float, float, float], float, bool]:
    """Find the wind in the frame of a tree, its drag density, if it is clamped."""
    half_cosine = float(here['cosine'])
    half_sine = float(here['sine'])
    cosine = half_cosine * half_cosine - half_sine * half_sine
    sine = 2.0 * half_cosine * half_sine
    east, north, up = (float(here['speed']) * wind).tolist()
    x = cosine * east + sine * north
    y = cosine * north - sine * east
    z = up
    speed = math.sqrt(x * x + y * y + z * z)
    load = drag_density(speed, *drag_law.tolist())
    most_pressure = float(table['most_pressure'])
    if not load * speed * speed > most_pressure:
        return (x, y, z), load, False
    share = math.sqrt(most_pressure / load) / speed
    return (share * x, share * y, share * z), load, True
