# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The library of the native core: ``sway.h`` and ``library.h`` of ``native/`` say what it does.

A test compares the signatures with these headers.
"""

from __future__ import annotations

from collections.abc import Callable
import ctypes
from pathlib import Path
import sys
from typing import Any, NoReturn
import weakref

from numpy.typing import NDArray

from tree_sway.errors import MissingDependencyError, ParameterError

VERSION = 1
"""Version of the interface, and of the bytes of a model."""

INTERFACE = 0xDA406528
"""CRC-32 of the headers ``sway.h`` and ``library.h``, which the library is asked for."""

FILE = Path(__file__).with_name('_sway.dll' if sys.platform == 'win32' else '_sway.so')
"""The library, which programs in other languages may link."""

_pointer, _size, _number = ctypes.c_void_p, ctypes.c_size_t, ctypes.c_double
_whole, _status = ctypes.c_int64, ctypes.c_int

SIGNATURES: dict[str, tuple[Any, tuple[Any, ...]]] = {
    'sway_version': (_status, ()),
    'sway_interface': (ctypes.c_uint32, ()),
    'sway_model_open': (_pointer, (_pointer, _size, _pointer, _size)),
    'sway_model_close': (None, (_pointer,)),
    'sway_model_sizes': (None, (_pointer, _pointer)),
    'sway_stand_open': (
        _pointer,
        (_pointer, _size, _pointer, _size, _size, _pointer, _size),
    ),
    'sway_stand_close': (None, (_pointer,)),
    'sway_state': (_pointer, (_pointer, _pointer, _pointer)),
    'sway_tune': (_status, (_pointer, _size, _pointer, _pointer)),
    'sway_set_step': (_status, (_pointer, _number)),
    'sway_step': (_status, (_pointer, _size, _size, _size, _pointer, _pointer)),
    'sway_place': (None, (_pointer, _size, _pointer, _size, _pointer)),
    'sway_step_first': (_status, (_pointer,)),
    'sway_place_first': (None, (_pointer,)),
    'sway_keys': (None, (_pointer, _size, _size, _pointer)),
    'sway_place_keys': (None, (_pointer, _size, _size, _pointer, _pointer)),
    'sway_past_winds': (
        None,
        (
            _pointer,
            _size,
            _number,
            _pointer,
            _pointer,
            _size,
            _number,
            _pointer,
            _number,
            _pointer,
        ),
    ),
    'sway_limb_winds': (None, (_pointer, _number, _number, _pointer, _number)),
    'sway_push_farwind': (None, (_pointer, _number, _number, _number, _number, _pointer)),
    # Motion sensors.
    'sway_keep_sample': (_status, (_pointer, _number, _pointer)),
    'sway_ask_for': (None, (_pointer, _whole)),
    'sway_read_samples': (_status, (_pointer, _number, _number, _pointer)),
    'sway_sample_period': (_number, (_pointer,)),
    'sway_read_sensors': (_whole, (_pointer, _whole, _whole, _number)),
    'sway_judge': (None, (_pointer, _number)),
    'sway_correct': (None, (_pointer, _pointer, _size)),
    'sway_try': (None, (_pointer, _pointer, _size, _pointer)),
    'sway_carry': (None, (_pointer, _pointer, _pointer, _number, _pointer, _pointer)),
    'sway_drag': (None, (_pointer, _pointer, _size, _pointer)),
    # Oscillators.
    'sway_steps': (None, (_pointer, _pointer, _size, _number, _pointer, _pointer)),
    'sway_propagators': (_whole, (_pointer, _pointer, _pointer, _size, _number, _pointer)),
    # Loads of winds on branches.
    'sway_wind_moments': (
        None,
        (_pointer, _pointer, _pointer, _pointer, _size, _pointer, _pointer),
    ),
    'sway_load_slopes': (
        None,
        (_pointer, _pointer, _pointer, _pointer, _size, _pointer, _pointer, _pointer),
    ),
    'sway_step_branches': (
        _whole,
        (_pointer, _size, _pointer, _pointer, _number, _number, _number, _number),
    ),
    'sway_rest_branches': (
        None,
        (_pointer, _size, _number, _number, _number, _number, _pointer, _pointer),
    ),
}
"""Result and arguments of every function."""


def _opened() -> ctypes.CDLL:
    cure = 'pip install . in the source of tree_sway_ros; it needs a C++ compiler'
    try:
        library = ctypes.CDLL(str(FILE))
    except OSError as error:
        raise MissingDependencyError('the native core is not built', cure=cure) from error
    # A structure with another field would be read wrongly without a word.
    other = MissingDependencyError('the native core is of other sources', cure=cure)
    for name, called in SIGNATURES.items():
        function = getattr(library, name, None)
        if function is None:
            raise other
        function.restype, function.argtypes = called
    if library.sway_interface() != INTERFACE:
        raise other
    return library


LIBRARY = _opened()


class NotCopied:
    """What steps by native memory: even a shallow copy would step that of the first."""

    def __copy__(self) -> NoReturn:
        cure = 'make another simulator of the same model, and give it the state() of this one'
        raise ParameterError('what the native core steps cannot be copied', cure=cure)


class Address(int):
    """
    Where memory is, or what the native core has opened.

    What holds one cannot be copied with its memory, nor be sent to another process: the copy would
    write to the memory of the first, also when that is gone. It raises a `ParameterError`.
    """

    def __reduce_ex__(self, _: object) -> NoReturn:
        NotCopied().__copy__()


class Opened:
    """
    What the native core has opened, which is closed when nothing is left that needs it.

    It stays open when Python ends: threads and what runs at exit may still use it.
    """

    def __init__(self, handle: int, close: Callable[[int], object], *needs: object) -> None:
        self.handle = Address(handle)
        self._needs = needs  # which outlive it
        weakref.finalize(self, close, handle).atexit = False


def contiguous(array: NDArray[Any], shape: tuple[int, ...] | None = None) -> Address:
    """
    Return where the numbers of an array begin, which the native core reads or writes in a row.

    Raises
    ------
    ValueError
        An array of another shape, or one whose numbers are not in a row.

    """
    if not array.flags.c_contiguous or (shape is not None and array.shape != shape):
        raise ValueError(f'an array of shape {array.shape} where {shape} in a row is read')
    return address(array)


def address(array: NDArray[Any]) -> Address:
    """Return where the numbers of an array begin."""
    return Address(array.ctypes.data)


class LastAddress:
    """Where the last array begins, kept: to find it takes longer than many calls."""

    def __init__(self) -> None:
        self._array: NDArray[Any] | None = None
        self._at = Address(0)

    def of(self, array: NDArray[Any]) -> Address:
        """Return where the numbers of an array begin."""
        if array is not self._array:
            self._array = array
            self._at = address(array)
        return self._at
