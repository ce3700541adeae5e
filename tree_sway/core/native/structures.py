# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Structures of ``native/library.h``, which says what their fields are.

A test compares them with the header.
"""

from __future__ import annotations

import ctypes
from typing import Any

from numpy.typing import NDArray

from tree_sway.core.native.library import Address, contiguous


def _fields(words: str, numbers: str = '') -> list[tuple[str, Any]]:
    """Return fields of whole numbers and addresses, and then of numbers."""
    whole = [(name, ctypes.c_int64) for name in words.split()]
    return [*whole, *((name, ctypes.c_double) for name in numbers.split())]


class Structure(ctypes.Structure):
    """
    A structure, which keeps its arrays.

    Parameters
    ----------
    **fields
        Numbers and contiguous arrays.

    """

    def __init__(self, **fields: float | NDArray[Any]) -> None:
        given = {name: _value(each) for name, each in fields.items()}
        super().__init__(**given)
        self._kept = fields
        self.at = Address(ctypes.addressof(self))
        """Where it is."""


def _value(field: float | NDArray[Any]) -> float:
    if isinstance(field, int | float):
        return field
    return contiguous(field)


class NativeFirst(Structure):
    """``sway_first``."""

    _fields_ = _fields('stand wind poses')


class NativeSeries(Structure):
    """``sway_series``."""

    _fields_ = _fields('rows half filled first second')


class NativeSensor(Structure):
    """``sway_sensor``."""

    _fields_ = _fields(
        'ring mounting kept computed moved series rows count is_mounted is_awaited in_use'
        ' is_refused silences disagreements',
        'dt absent unheard newest apart excess usual agreed thrown heard came lag',
    )


class NativeReadings(Structure):
    """``sway_readings``."""

    _fields_ = _fields(
        'sensors coordinates corrected late sensor shapes stiffness damping air_damping eta rate'
        ' force sensed still beyond is_known'
    )


class NativeFilter(Structure):
    """``sway_filter``."""

    _fields_ = _fields(
        'coordinates measurements law sensed gain deviation row state calm innovations'
    )


class NativeCorrection(Structure):
    """``sway_correction``."""

    _fields_ = _fields('coordinates stiffness wanted trust leaning moved energies')


class NativeDragged(Structure):
    """``sway_dragged``."""

    _fields_ = _fields('coordinates corrected law drag push trust state')


class NativeFarWind(Structure):
    """``sway_farwind``."""

    _fields_ = _fields(
        'parts stages directions samples is_sample length weights share rest memory whole'
    )
