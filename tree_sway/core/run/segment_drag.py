# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Drag of the wind on every segment of a tree at its pose, as it is placed.

The force on a segment of area A is ``p A |u| u`` with u the velocity of the air across the segment
and p `drag_law.drag_density`. The velocity of the segment is the difference of its places a little
ahead and behind along the motion. A segment's load on a coordinate is the work that its force does
per unit of it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tree_sway.core.arrays import Floats, Ints, Records
from tree_sway.core.kernel import LOOP_OPTIONS, WHY_PLAIN
from tree_sway.core.model.sway_model import SwayModel


class SegmentDrag(NamedTuple):
    """What the drag of n segments needs, and the forces."""

    area: Floats
    """Drag area of each [m^2], (n,)."""
    speed: Floats
    """Wind speed at each over that at the anemometer, (n,)."""
    gust: Floats
    """Wind that reaches each beside that at the anemometer [m/s], (n, 3)."""
    branch: Ints
    """Number of the branch of each, (n,)."""
    root_mass: Floats
    """Square root of the mass of each [kg^0.5], (n,)."""
    tangent: Floats
    """Directions of the segments at the pose, one after another, (3 n,)."""
    force: Floats
    """Forces at 1 kg/m^3 over the square roots of the masses, (3 n,), written."""


def segment_drag(model: SwayModel, branches: Records, tangent: Floats) -> SegmentDrag:
    """
    Lay out the drag on the segments of a model.

    Parameters
    ----------
    model
        The model. The area of a branch beyond that of its wood is leaves, spread evenly along it.
    branches
        Its records of `Branch`, (b,).
    tangent
        Directions of the segments, (3 n,), which `Middles` writes.

    """
    tree = model.tree
    first = model.branch_first[:-1]
    branch = np.repeat(np.arange(len(first)), np.diff(model.branch_first))
    wood = 0.5 * tree.length * (tree.base_diameter + tree.tip_diameter)
    of_wood = np.add.reduceat(wood, first)
    along = np.add.reduceat(tree.length, first)
    clad = np.minimum(branches['area'] / of_wood, 1.0)
    leaves = np.maximum(branches['area'] - of_wood, 0.0) / along
    return SegmentDrag(
        area=wood * clad[branch] + tree.length * leaves[branch],
        speed=branches['speed'][branch],
        gust=np.zeros((len(wood), 3)),
        branch=branch,
        root_mass=np.sqrt(model.segment_mass),
        tangent=tangent,
        force=np.zeros(3 * len(wood)),
    )


def damping_at_rest(drag: SegmentDrag, columns: Floats) -> Floats:
    """
    Return the damping of each coordinate by still air at most, per drag and speed, (m,).

    Columns are displacements of the segments at rest per unit of each coordinate, times the square
    roots of the masses, (m, 3 n).
    """
    per_mass = 2.0 * drag.area * drag.speed / drag.root_mass**2
    return np.asarray(np.square(columns) @ np.repeat(per_mass, 3))


def fill_drag(
    drag: SegmentDrag, ahead: Floats, behind: Floats, per_time: float,
    wx: float, wy: float, wz: float,
) -> None:  # fmt: skip
    """
    Write the forces of a wind [m/s] at 1 kg/m^3.

    Parameters
    ----------
    drag
        The segments, with their directions.
    ahead, behind
        Places of `Middles` ahead and behind along the motion, (3 n,).
    per_time
        One over the time between them [1/s]; 0 for a tree at rest.

    """
    moved = per_time * (ahead - behind).reshape(-1, 3)
    wind = np.array([wx, wy, wz]) + drag.gust
    air = drag.speed[:, None] * wind - moved / drag.root_mass[:, None]
    tangent = drag.tangent.reshape(-1, 3)
    air -= (air * tangent).sum(axis=1, keepdims=True) * tangent
    factor = drag.area * np.sqrt((air * air).sum(axis=1)) / drag.root_mass
    drag.force[:] = (factor[:, None] * air).ravel()


if not WHY_PLAIN:
    from numba.extending import overload

    @overload(fill_drag, jit_options=LOOP_OPTIONS)
    def _fill_drag(drag, ahead, behind, per_time, wx, wy, wz):  # type: ignore[no-untyped-def]
        def loop(drag, ahead, behind, per_time, wx, wy, wz):  # type: ignore[no-untyped-def]
            tangent = drag.tangent
            force = drag.force
            for i in range(len(drag.area)):
                x = 3 * i
                y = 3 * i + 1
                z = 3 * i + 2
                per_mass = per_time / drag.root_mass[i]
                ux = drag.speed[i] * (wx + drag.gust[i, 0]) - per_mass * (ahead[x] - behind[x])
                uy = drag.speed[i] * (wy + drag.gust[i, 1]) - per_mass * (ahead[y] - behind[y])
                uz = drag.speed[i] * (wz + drag.gust[i, 2]) - per_mass * (ahead[z] - behind[z])
                along = ux * tangent[x] + uy * tangent[y] + uz * tangent[z]
                ux -= along * tangent[x]
                uy -= along * tangent[y]
                uz -= along * tangent[z]
                across = np.sqrt(ux * ux + uy * uy + uz * uz)
                factor = drag.area[i] * across / drag.root_mass[i]
                force[x] = factor * ux
                force[y] = factor * uy
                force[z] = factor * uz

        return loop
