# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Kernels of a stand: many trees on few tables, solved in one call and placed kind by kind.

A tree of a stand is its kind rotated about the vertical, scaled, and moved to its place. A tree
scaled by k bends by the same angles in the same wind, and swings k times slower: its inertia is
proportional to the fifth power of its size, its stiffness and the wind's moment to the third. So
it is stepped as its kind, by 1/k of the time. (Gravity and the profile of the wind are those of
the kind, with the wind speed at the height of the tree.)
"""

from __future__ import annotations

import math
from typing import Annotated

import numpy as np

from tree_sway.core.arrays import fields_of, Floats, Ints, RecordsOf, Singles
from tree_sway.core.kernel import fused, part
from tree_sway.core.model.drag_law import drag_density
from tree_sway.core.model.records import Blocks, Instance, Instances, Segments, Tables, TimeSteps
from tree_sway.core.run.past_caches import settle, write_past_caches
from tree_sway.core.run.placing import NONE, place
from tree_sway.core.run.table_model import step_instance


class Placement:
    """Place and kind of a tree of a stand."""

    kind: int  # row of its table
    time_step: int  # row of its time step
    is_still: int  # 1 where it is not solved
    is_clamped: int  # 1 where its last wind was clamped to the limit of the table
    scale: float  # height over that of its kind
    speed: float  # wind at its height over that at its kind's height
    cosine: float  # cosine of half its rotation about the vertical
    sine: float
    at: Annotated[Floats, 3]  # root node [m]


Placements = RecordsOf[Placement]
PLACEMENT = np.dtype(fields_of(Placement))

_CACHED = 1 << 21
"""Largest pose block in numbers that is written to the caches: 16 MB, half of a large cache."""


@fused
def step_stand(
    tables: Tables,
    time_steps: TimeSteps,
    placements: Placements,
    instances: Instances,
    drag_laws: Floats,
    winds: Floats,
) -> tuple[int, int]:
    """
    Step every tree that is not still, in its mean wind over the step in [m/s], (t, 3).

    Records are of `table_layout` (k,), `time_step_layout` (p,), `PLACEMENT` and
    `instance_layout` (t,); C, N and C0 of the `DragLaw` of each kind (k, 3).

    Returns
    -------
    tuple
        Trees whose wind or lean was clamped to the limit of their table, and trees whose motion
        was not finite and that continue from rest.

    """
    n_clamped = 0
    n_restarted = 0
    for number in range(len(placements)):
        here = placements[number]
        if here.is_still:
            continue
        table = tables[here.kind]
        instance = instances[number]
        x, y, z = _wind_in_frame(here, winds[number])
        speed = math.sqrt(x * x + y * y + z * z)
        law = drag_laws[here.kind]
        load = drag_density(speed, law[0], law[1], law[2])
        here.is_clamped = load * speed * speed > table.most_pressure
        if here.is_clamped:
            fraction = math.sqrt(table.most_pressure / load) / speed
            x = fraction * x
            y = fraction * y
            z = fraction * z
        time_step = time_steps[here.time_step]
        is_outside = step_instance(table, time_step, instance, True, x, y, z, load)
        n_clamped += 1 if here.is_clamped else is_outside
        if not _is_finite(instance):
            _come_to_rest(instance)
            n_restarted += 1
    return n_clamped, n_restarted


@part
def _wind_in_frame(here: Placement, wind: Floats) -> tuple[float, float, float]:
    """Return the wind at the height of a tree, in the frame of its kind."""
    cosine = here.cosine * here.cosine - here.sine * here.sine
    sine = 2.0 * here.cosine * here.sine
    return (
        here.speed * (cosine * wind[0] + sine * wind[1]),
        here.speed * (cosine * wind[1] - sine * wind[0]),
        here.speed * wind[2],
    )


@part
def _is_finite(instance: Instance) -> bool:
    """Whether all coordinates and rates are finite."""
    n_finite = 0
    for mode in range(len(instance.eta)):  # without an exit, so that the loop is a vector
        n_finite += math.isfinite(instance.eta[mode]) and math.isfinite(instance.rate[mode])
    return n_finite == len(instance.eta)


@part
def _come_to_rest(instance: Instance) -> None:
    for mode in range(len(instance.eta)):
        instance.eta[mode] = 0.0
        instance.rate[mode] = 0.0
        instance.force[mode] = 0.0
        instance.middle[mode] = 0.0
        instance.middle_rate[mode] = 0.0


@fused
def place_stand(
    placements: Placements,
    instances: Instances,
    trees: Ints,
    shapes: Singles,
    segments: Segments,
    blocks: Blocks,
    bases: Floats,
    rotations: Floats,
    poses: Floats,
    out: Floats,
) -> None:
    """
    Place trees of one kind.

    Each is placed in memory that stays in the cache, then written in one run, which is faster than
    to write single branches to other memory.

    Parameters
    ----------
    placements, instances
        Records, as in `step_stand`.
    trees
        Their numbers and first rows in the pose block, (w, 2).
    shapes
        Shapes of the kind, as in `placing.expand`.
    segments, blocks, bases
        Records and bases of the kind, as in `placing.place`.
    rotations, poses
        Scratch memory of one tree, (N,) and (m, 7).
    out
        Pose block of the stand, (n, 7), rows of these trees written.

    """
    own = poses.reshape(-1)
    whole = out.reshape(-1)
    for row in range(len(trees)):
        number = trees[row, 0]
        first = trees[row, 1]
        here = placements[number]
        place(
            instances[number : number + 1], shapes, segments, blocks, bases,
            here.cosine, here.sine, here.scale, rotations, NONE, here.at[:], poses,
        )  # fmt: skip
        rows = whole[7 * first : 7 * first + len(own)]
        if len(whole) > _CACHED:
            write_past_caches(own, rows)
        else:
            for i in range(len(own)):
                rows[i] = own[i]
    settle()
