# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Units of speeds in tables that do not say them: those of the maker, known by the names of columns.

A table without a unit and of no known maker is taken in m/s, which a note says.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from tree_sway.errors import ParameterError
from tree_sway.files.column_names import unit_factor, UNITS
from tree_sway.files.makers import maker_of
from tree_sway.files.table_file import TextTable

_ASKED = '?'
"""Unit of a maker whose files do not say it."""
_CURE = 'give it: --wind-option speed_unit=mph (or km/h, kn, m/s)'


@dataclass(frozen=True, slots=True)
class SpeedUnits:
    """Factors to [m/s] of the speed and the gust of a table, and what was assumed."""

    speed: float
    gust: float
    note: str = ''


def speed_units(table: TextTable, columns: Mapping[str, int], given: str | None) -> SpeedUnits:
    """
    Return the units of speeds whose columns are by their quantity.

    The header counts first, then the unit ``given``, then the maker's. Raises a `ParameterError`
    for an unknown unit, and a `FormatError` where a known maker's file does not tell its unit.
    """
    if given is not None and unit_factor('speed', given) is None:
        cure = f'use one of: {", ".join(UNITS["speed"])}'
        raise ParameterError(f"speed_unit is '{given}'", cure=cure)
    factors = dict[str, float]()
    notes = list[str]()
    maker = maker_of(table)
    for quantity in ('wind_speed', 'gust'):
        if quantity not in columns:
            factors[quantity] = 1.0
        elif table.unit_of(columns[quantity], quantity):
            factors[quantity] = table.factor_of(columns[quantity], quantity)
        else:
            unit = given or _unit_of(maker, quantity, table)
            factors[quantity] = unit_factor('speed', unit or 'm/s') or 1.0
            notes.append(_note(unit, given, maker))
    return SpeedUnits(factors['wind_speed'], factors['gust'], next(iter(notes), ''))


def _unit_of(maker: dict[str, Any], quantity: str, table: TextTable) -> str | None:
    unit: str = maker.get('gust' if quantity == 'gust' else 'speed', '')
    if unit == _ASKED:
        what = f'a file of {maker["maker"]} does not say the unit of the speed'
        raise table.error(what, cure=_CURE)
    return unit or None


def _note(unit: str | None, given: str | None, maker: dict[str, Any]) -> str:
    if given is not None:
        return f'speeds are taken in {given}, as given'
    if unit is not None:
        return f'speeds are in {unit}, as {maker["maker"]} has them'
    how = '--wind-option speed_unit=km/h changes it'
    return f'no unit of the speed in the header: taken in m/s; {how}'
