# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Memory of the wind load on every branch: a record of work each, and one of load for sixteen.

The model `full` sums the load over the branches.
"""

from __future__ import annotations

from functools import cache
from typing import Annotated, Any, overload, Protocol, TypeVar

import numpy as np

from tree_sway.core.arrays import fields_of, Floats, Records
from tree_sway.core.model import Branch, WIDTH

_Record = TypeVar('_Record', covariant=True)


class RecordsOf(Protocol[_Record]):
    """Records as compiled code reads them: fields of one are attributes, typed as its class."""

    def __len__(self) -> int: ...

    @overload
    def __getitem__(self, index: int, /) -> _Record: ...

    @overload
    def __getitem__(self, index: slice, /) -> RecordsOf[_Record]: ...


class Work:
    """Motion and loads of a branch, passed from one pass of a step to the next."""

    velocity: Annotated[Floats, 6]  # velocity and spin of the base in its own, turned frame
    orientation: Annotated[Floats, 4]  # rotation of the base from rest, w x y z
    force: Annotated[Floats, 3]  # wind force on the branch in the last step [N]
    rotation: Annotated[Floats, 3]  # rotation vector of the base from the parent's base
    # Displacement of the base in the frame of the parent's base:
    displacement: Annotated[Floats, 3]
    arm: Annotated[Floats, 3]  # position of the base from the parent's base, bent
    wrench: Annotated[Floats, 6]  # force and moment on the branch and its subtree (`branch_loads`)


class Load:
    """
    Wind load of sixteen consecutive branches, and the data for it.

    Rows are coordinates; rows that a branch does not have are zero.
    """

    n_rows: int  # largest number of coordinates of a branch
    # As in `Branch`:
    speed: Annotated[Floats, WIDTH]
    area: Annotated[Floats, WIDTH]
    spread: Annotated[Floats, WIDTH]
    projector: Annotated[Floats, 6, WIDTH]
    damping_mode: Annotated[Floats, 'rows', 3, WIDTH]
    load_rotation: Annotated[Floats, 'rows', 3, WIDTH]
    load_mode: Annotated[Floats, 'rows', 3, WIDTH]
    coupling: Annotated[Floats, 3, 3, WIDTH]  # moment about the base per force [m]
    # Set with the time step:
    compliance: Annotated[Floats, WIDTH]  # velocity half a step after a unit of force [s/kg]
    # Set with the wind:
    gust: Annotated[Floats, 3, WIDTH]  # wind of the branch less that of the tree [m/s]
    # State at the middle of the step, and quantities derived from it:
    x: Annotated[Floats, 'rows', WIDTH]
    v: Annotated[Floats, 'rows', WIDTH]
    velocity: Annotated[Floats, 6, WIDTH]  # velocity and spin of the base in its own, turned frame
    air_velocity: Annotated[Floats, 3, WIDTH]  # wind in that frame [m/s]
    rotation: Annotated[Floats, 3, WIDTH]  # rotation of the loaded pieces in that frame
    # Reduction of the relative wind by the last force, over the compliance [N]:
    drag_impulse: Annotated[Floats, 3, WIDTH]
    own_force: Annotated[Floats, 3, WIDTH]  # force in the turned frame of the branch [N]
    force: Annotated[Floats, 3, WIDTH]  # force in the frame of the base [N]
    moment: Annotated[Floats, 3, WIDTH]  # moment about the base in its frame [N m]
    load: Annotated[Floats, 'rows', WIDTH]  # load on each coordinate [N m]


Branches = RecordsOf[Branch]
Works = RecordsOf[Work]
Loads = RecordsOf[Load]


WORK = np.dtype(fields_of(Work))


@cache
def load_layout(n_coordinates: int) -> np.dtype[np.void]:
    """Lay out `Load`, with room for a number of coordinates."""
    return whole_lines(fields_of(Load, rows=n_coordinates))


_LINE = 64
"""Bytes of a cache line, and of the widest vector."""


def whole_lines(fields: list[tuple[Any, ...]]) -> np.dtype[np.void]:
    """Lay fields of whole vectors out first, then the others, padded to whole cache lines."""
    packed: Any = np.dtype(sorted(fields, key=lambda field: len(field) < 3))
    by_name: dict[str, Any] = dict(packed.fields or {})
    return np.dtype(
        {
            'names': list(by_name),
            'formats': [kind[0] for kind in by_name.values()],
            'offsets': [kind[1] for kind in by_name.values()],
            'itemsize': -(-packed.itemsize // _LINE) * _LINE,
        }
    )


def zeros_in_lines(count: int, layout: np.dtype[np.void]) -> Records:
    """Return a number of records of zeros, the first at the beginning of a cache line."""
    memory = np.zeros(count * layout.itemsize + _LINE, dtype=np.uint8)
    first = -memory.ctypes.data % _LINE
    return memory[first : first + count * layout.itemsize].view(layout)
