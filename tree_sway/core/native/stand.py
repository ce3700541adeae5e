# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Trees of the native core: their states, steps and poses."""

from __future__ import annotations

from array import array
from collections.abc import Callable, Sequence
import ctypes
from functools import partial
from typing import NamedTuple

import numpy as np

from tree_sway.core.arrays import Floats, Ints
from tree_sway.core.native.library import address, LastAddress, LIBRARY, Opened
from tree_sway.core.native.model import NativeModel
from tree_sway.core.native.structures import NativeFirst
from tree_sway.errors import ParameterError

_ROOM = 300
_TREE = np.dtype(
    [('model', 'i8'), ('at', 'f8', 3), ('yaw', 'f8'), ('scale', 'f8'), ('speed', 'f8')]
)
"""``sway_tree`` of the header."""

_EVERY_ROOM = ctypes.c_size_t(-1).value
"""``SWAY_EVERY_ROOM`` of the header."""


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
    threads
        Threads that share the trees, 1 or more; if None, a stand of some 100,000 segments or more
        has one for each processor that the process may use, up to eight. No bit of the result
        depends on it.

    Raises
    ------
    ParameterError
        Numbers of trees that are not finite, or models that do not exist.

    """

    def __init__(
        self,
        models: Sequence[NativeModel],
        kinds: Ints,
        places: Floats,
        speeds: Floats,
        threads: int | None = None,
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
        handle = LIBRARY.sway_stand_open(
            handles, len(models), address(trees), len(trees), threads or 0, error, _ROOM
        )
        if not handle:
            raise ParameterError(error.value.decode(), where='trees')
        opened = Opened(handle, LIBRARY.sway_stand_close, *self.models)
        self._handle = opened.handle
        self.states = self._views(len(trees), opened)
        self._counts = np.zeros(2, dtype=np.int64)
        self._counts_at = address(self._counts)
        self._winds_at = LastAddress()
        self._rows_at = LastAddress()
        self._keys_at = LastAddress()
        self._poses_at = LastAddress()
        self.wind = array('d', (0.0, 0.0, 0.0))
        """Wind in which `step_first` steps the first tree [m/s]."""
        self._first = NativeFirst(stand=handle, wind=self.wind.buffer_info()[0])
        self._filled: Floats | None = None
        # An argument that is made once is passed on in half the time.
        first_at = ctypes.c_void_p(self._first.at)
        self.step_first: Callable[[], int] = partial(LIBRARY.sway_step_first, first_at)
        """Step the first tree in `wind`; returns the bits of ``sway_step``."""
        self._place_first = partial(LIBRARY.sway_place_first, first_at)

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

    def step(self, winds: Floats) -> tuple[int, int]:
        """
        Step every tree in its wind [m/s], (t, 3).

        Returns
        -------
        tuple
            Trees whose wind or energy was clamped, and trees whose motion was not finite and that
            go on from rest.

        """
        winds_at = self._winds_at.of(winds)
        LIBRARY.sway_step(self._handle, _EVERY_ROOM, 0, len(winds), winds_at, self._counts_at)
        clamped, restarted = self._counts.tolist()
        return clamped, restarted

    def place_first(self, out: Floats) -> None:
        """Place the first tree, (n, 7); ``out`` is contiguous."""
        if out is not self._filled:
            self._first.poses = address(out)
            self._filled = out
        self._place_first()

    def place(self, rows: Ints, out: Floats) -> None:
        """Place trees: their numbers and first rows in a pose block, (w, 2)."""
        rows_at, poses_at = self._rows_at.of(rows), self._poses_at.of(out)
        LIBRARY.sway_place(self._handle, _EVERY_ROOM, rows_at, len(rows), poses_at)

    def keys(self, tree: int, out: Floats) -> None:
        """Write the key rotations of a tree [rad], (N,)."""
        LIBRARY.sway_keys(self._handle, 0, tree, self._keys_at.of(out))

    def place_keys(self, tree: int, keys: Floats, out: Floats) -> None:
        """Place a tree by key rotations [rad], (N,), in a pose block of its own, (n, 7)."""
        keys_at = self._keys_at.of(keys)
        LIBRARY.sway_place_keys(self._handle, 0, tree, keys_at, self._poses_at.of(out))
