# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Trees of the native core: their states, steps and poses."""

from __future__ import annotations

from collections.abc import Callable, Sequence
import ctypes
import os
from threading import Thread
from typing import NamedTuple

import numpy as np

from tree_sway.core.arrays import Floats, Ints
from tree_sway.core.native.library import address, LastAddress, LIBRARY, Opened
from tree_sway.core.native.model import NativeModel
from tree_sway.errors import ParameterError

_ROOM = 300
_LARGE = 100_000
"""Trees times segments of the largest beyond which each frame is shared among processors."""

_MOST_THREADS = 8
"""Threads beyond which the memory is the limit."""

_TREE = np.dtype(
    [('model', 'i8'), ('at', 'f8', 3), ('yaw', 'f8'), ('scale', 'f8'), ('speed', 'f8')]
)
"""``sway_tree`` of the header."""


class States(NamedTuple):
    """States of the trees of a stand, views of its memory; M is the width of a row."""

    eta: Floats
    """Coordinates, (t, M)."""
    rate: Floats
    force: Floats
    """Force of the last step, (t, M)."""
    hidden: Floats
    """Part of each coordinate that is not shown, (t, M)."""
    diagonal: Floats
    """Derivative of the force by the own rate, (t, M)."""
    wanted: Floats
    """Force of the wind, (t, M)."""
    wind: Floats
    """Wind of the last step [m/s], (t, 3)."""
    drag_density: Floats
    """Drag per area and squared speed [kg/m^3], (t,)."""
    is_clamped: Floats
    """1 where the last step was clamped, (t,)."""
    left_out: Floats
    """Number of last coordinates that are neither shown nor loaded, (t,)."""
    at_rest: Floats
    """Number of last coordinates that are kept at rest, (t,)."""
    history: Floats
    """History of the wind where gusts reach limbs one after another, (t, h)."""


class NativeStand:
    """
    Trees of some models, each at a place.

    A stand of some 100,000 segments or more is stepped and placed by as many threads as the process
    has processors, up to eight; their number does not change a bit of the result.

    Parameters
    ----------
    models
        Models of the native core.
    kinds
        Number of the model of each tree, (t,).
    places
        x, y, z [m] of the root node, turn about the vertical [rad] and scale, (t, 5).
    speeds
        Wind of each tree over that of its model, (t,).

    Raises
    ------
    ParameterError
        Numbers of trees that are not finite, or models that do not exist.

    """

    def __init__(
        self, models: Sequence[NativeModel], kinds: Ints, places: Floats, speeds: Floats
    ) -> None:
        self.models = tuple(models)
        """Models of the trees."""
        trees = np.zeros(len(kinds), dtype=_TREE)
        trees['model'] = kinds
        trees['at'] = places[:, :3]
        trees['yaw'] = places[:, 3]
        trees['scale'] = places[:, 4]
        trees['speed'] = speeds
        handles = (ctypes.c_void_p * len(models))(*(each.opened.handle for each in models))
        error = ctypes.create_string_buffer(_ROOM)
        largest = max((each.sizes.segments for each in models), default=0)
        self._n_rooms = _threads() if largest * len(trees) > _LARGE else 1
        handle = LIBRARY.sway_stand_open(
            handles, len(models), address(trees), len(trees), self._n_rooms, error, _ROOM
        )
        if not handle:
            raise ParameterError(error.value.decode(), where='trees')
        opened = Opened(handle, LIBRARY.sway_stand_close, *self.models)
        self._handle = opened.handle
        self.states = self._views(len(trees), opened)
        self._counts = np.zeros((self._n_rooms, 2), dtype=np.int64)
        self._counts_at = address(self._counts)
        self._winds_at = LastAddress()
        self._rows_at = LastAddress()
        self._wind = (ctypes.c_double * 3)()
        self._first_row = np.zeros((1, 2), dtype=np.int64)
        self._first_row_at = address(self._first_row)
        self._keys_at = LastAddress()
        self._poses_at = LastAddress()

    def _views(self, count: int, opened: Opened) -> States:
        """Return views of the states; they keep its memory."""
        stride, width = ctypes.c_size_t(), ctypes.c_size_t()
        first = LIBRARY.sway_state(self._handle, ctypes.byref(stride), ctypes.byref(width))
        memory = (ctypes.c_double * (count * stride.value)).from_address(first)
        memory.opened = opened  # type: ignore[attr-defined]
        self._rows = rows = np.ctypeslib.as_array(memory).reshape(count, stride.value)
        m = width.value
        scalars = rows[:, 6 * m :]
        coordinates = [rows[:, row * m : (row + 1) * m] for row in range(6)]
        single = [scalars[:, k] for k in range(3, 7)]
        return States._make([*coordinates, scalars[:, :3], *single, scalars[:, 8:]])

    def reset(self) -> None:
        """Return every tree to rest."""
        self._rows[:] = 0.0

    def set_step(self, dt: float) -> None:
        """Set the length of the steps [s], above 0 and finite."""
        LIBRARY.sway_set_step(self._handle, dt)

    def tune(self, kind: int, stiffness: Floats, damping: Floats) -> None:
        """
        Set stiffness [1/s^2] and damping [1/s] of the coordinates of a model, (m,).

        They count from the next `set_step` on; raises a `ParameterError` for negative numbers.
        """
        own = np.ascontiguousarray(stiffness), np.ascontiguousarray(damping)
        if LIBRARY.sway_tune(self._handle, kind, *map(address, own)):
            raise ParameterError('stiffness or damping that no tree has', where='tune')

    def step_first(self, x: float, y: float, z: float) -> int:
        """Step the first tree in a wind [m/s]; returns the bits of ``sway_step``."""
        wind = self._wind
        wind[0] = x
        wind[1] = y
        wind[2] = z
        return int(LIBRARY.sway_step(self._handle, 0, 0, 1, wind, None))

    def step(self, winds: Floats) -> tuple[int, int]:
        """
        Step every tree in its wind [m/s], (t, 3).

        Returns
        -------
        tuple
            Trees whose wind or energy was clamped, and trees whose motion was not finite and that
            go on from rest.

        """
        first, counts = self._winds_at.of(winds), self._counts_at

        def step(room: int, begin: int, end: int) -> None:
            own = first + 24 * begin, counts + 16 * room
            LIBRARY.sway_step(self._handle, room, begin, end - begin, *own)

        self._share(len(winds), step)
        clamped, restarted = self._counts.sum(axis=0).tolist()
        return clamped, restarted

    def _share(self, count: int, work: Callable[[int, int, int], None]) -> None:
        """Share trees among threads: work by number of the room, first tree and end."""
        if self._n_rooms == 1:
            work(0, 0, count)
            return
        ends = [count * room // self._n_rooms for room in range(self._n_rooms + 1)]
        own, *others = zip(range(self._n_rooms), ends, ends[1:], strict=False)
        threads = [Thread(target=work, args=part) for part in others]
        for thread in threads:
            thread.start()
        work(*own)
        for thread in threads:
            thread.join()

    def place_first(self, out: Floats) -> None:
        """Place the first tree, (n, 7); ``out`` is contiguous."""
        LIBRARY.sway_place(self._handle, 0, self._first_row_at, 1, self._poses_at.of(out))

    def place(self, rows: Ints, out: Floats) -> None:
        """Place trees: their numbers and first rows in a pose block, (w, 2)."""
        first, poses = self._rows_at.of(rows), self._poses_at.of(out)

        def place(room: int, begin: int, end: int) -> None:
            LIBRARY.sway_place(self._handle, room, first + 16 * begin, end - begin, poses)

        self._share(len(rows), place)

    def keys(self, tree: int, out: Floats) -> None:
        """Write the key rotations of a tree [rad], (N,)."""
        LIBRARY.sway_keys(self._handle, 0, tree, self._keys_at.of(out))

    def place_keys(self, tree: int, keys: Floats, out: Floats) -> None:
        """Place a tree by key rotations [rad], (N,), in a pose block of its own, (n, 7)."""
        keys_at = self._keys_at.of(keys)
        LIBRARY.sway_place_keys(self._handle, 0, tree, keys_at, self._poses_at.of(out))


def _threads() -> int:
    """Return the number of threads of a large stand."""
    of_process = getattr(os, 'sched_getaffinity', None)
    count = len(of_process(0)) if of_process else os.cpu_count() or 1
    return min(count, _MOST_THREADS)
