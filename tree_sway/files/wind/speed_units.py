# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Units of speeds in tables that do not say them: those of the maker, known by the names of columns.

A table without a unit and of no known maker is taken in m/s, which a note says.
"""

from __future__ import annotations

from tree_sway.errors import ParameterError
from tree_sway.files.column_names import unit_factor, UNITS
from tree_sway.files.makers import maker_of
from tree_sway.files.table_file import TextTable

_ASKED = '?'
"""Unit of a maker whose files do not say it."""
_CURE = 'give it: --wind-option speed_unit=mph (or km/h, kn, m/s)'


def speed_factor(
    table: TextTable, index: int, quantity: str, given: str | None
) -> tuple[float, str]:
    """
    Return the factor to [m/s] of a column of speeds or gusts, and what was assumed; may be empty.

    The header counts first, then the unit ``given``, then the maker's. Raises a `ParameterError`
    for an unknown unit, and a `FormatError` where a known maker's file does not tell its unit.
    """
    if given is not None and unit_factor('speed', given) is None:
        raise ParameterError(
            f"speed_unit is '{given}'", cure=f'use one of: {", ".join(UNITS["speed"])}'
        )
    if table.unit_of(index, quantity):
        return table.factor_of(index, quantity), ''
    maker = maker_of(table)
    unit = given or maker.get('gust' if quantity == 'gust' else 'speed')
    if unit == _ASKED:
        raise table.error(
            f'a file of {maker["maker"]} does not say the unit of the speed', cure=_CURE
        )
    if given is not None:
        note = f'speeds are taken in {given}, as given'
    elif unit:
        note = f'speeds are in {unit}, as {maker["maker"]} has them'
    else:
        how = '--wind-option speed_unit=km/h changes it'
        note = f'no unit of the speed in the header: taken in m/s; {how}'
    return unit_factor('speed', unit or 'm/s') or 1.0, note
