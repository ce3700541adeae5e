# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Columns of motion in a table: their quantities and axes, units that are not told, and their times.

A missing unit is told by the lines above the header or the maker of the table, by gravity in
accelerations, and by rates and angles that are none in radians; that of time by how far samples
are apart. What was assumed is a note.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
import re

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.files.column_names import (
    ANGLES,
    FILES_OF,
    folded,
    motion_of,
    name_and_unit,
    TOLD_BY_SIZE,
    unit_known,
)
from tree_sway.files.makers import maker_of
from tree_sway.files.table_file import TextTable
from tree_sway.files.time_stamps import Times

Motions = dict[tuple[str, str], dict[str, int]]
"""Places of columns by their axes, of each quantity and name."""

_VECTORS = ('rate', 'acceleration')
_BARE_AXIS = re.compile(r'(?:axis)?([xyz])(?:axis|value)?')
_GRAVITY = (8.5, 11.2)
"""Range of the median of accelerations with gravity [m/s^2]."""
_UNITS = {'': 1.0, 'g': 9.80665, 'mg': 0.00980665, 'mm/s^2': 0.001}
"""Units that gravity tells, of which none is that of SI."""
_SLOWEST = 1.0
"""Longest time between samples that may tell a sway in [s]."""
_OLDEST = 946_684_800.0
"""Date before which a number is no time since 1970: 2000-01-01 [s]."""
_FINER = {'ms': 1e-3, 'us': 1e-6, 'ns': 1e-9}
_USUAL_STEP = (2e-3, 0.2)
"""Times between samples that tell the unit of their times in [s]."""
_SHORTEST = 5e-4
"""Time between samples that no motion sensor falls below [s]."""


def motions_of(table: TextTable, other: str = '') -> Motions:
    """
    Return the places of the axes of each quantity and name, in the order of the columns.

    Columns without an axis are under an empty name. Those called x, y and z alone are of the
    quantity of their unit, of the name of the file, or of an acceleration with gravity, else of
    the ``other`` one. A `FormatError` refuses an axis of which two columns have one name.
    """
    found: Motions = {}
    for index, column in enumerate(table.columns):
        bare = _BARE_AXIS.fullmatch(folded(name_and_unit(column, 'acceleration')[0]))
        quantity, name, axis = ('', '', bare[1]) if bare else motion_of(column) or ('', '', '')
        is_time = unit_known('time', name_and_unit(column, 'time')[1])  # as X [s] of Delsys
        if (axis or quantity) and not is_time:
            key = quantity, name if axis else ''
            first = found.setdefault(key, {}).setdefault(axis or column, index)
            if first != index and table.columns[first] == column:
                raise table.error(
                    f"several columns are called '{column}'",
                    cure='keep those of one place, or tell them apart by their names',
                )
    axes = found.pop(('', ''), {})
    quantity = _quantity_of(table, [*axes.values()], other)
    return found | ({(quantity, ''): axes} if axes and quantity else {})


def _quantity_of(table: TextTable, columns: Sequence[int], other: str) -> str:
    """Return what columns called x, y and z are; empty for no motion."""
    if len(columns) < len('xyz'):
        return other
    units = [table.unit_of(each, 'rate') for each in columns]
    if any(units):
        alike = (each for each in _VECTORS if all(unit_known(each, unit) for unit in units))
        return next(alike, other)
    stem = folded(Path(table.source).stem)
    named = [each for each, words in FILES_OF.items() if words.search(stem)]
    return named[0] if named else 'acceleration' if gravity_in(table.values(columns)) else other


def gravity_in(values: Floats) -> tuple[str, ...]:
    """Return the unit of accelerations in which gravity is; nothing without it."""
    size = _size(values)
    units = _UNITS.items()
    return tuple(unit for unit, each in units if _GRAVITY[0] < size * each < _GRAVITY[1])


def _size(values: Floats, share: float = 0.5) -> float:
    """Return the length of vectors that a share of them stays below; 0 without one."""
    size = np.linalg.norm(values, axis=1)
    size = size[np.isfinite(size)]
    return float(np.quantile(size, share, method='lower')) if len(size) else 0.0


def in_si(
    table: TextTable, columns: Sequence[int], quantity: str, *, is_scale_needed: bool = True
) -> tuple[Floats, str]:
    """
    Numbers of the columns of a quantity in units of SI, (n, k), and what was assumed.

    Where the scale is needed, a `FormatError` refuses those that are too large without a unit.
    """
    values = table.values(columns)
    if quantity not in TOLD_BY_SIZE or table.unit_of(columns[0], quantity):
        return values * [table.factor_of(each, quantity) for each in columns], ''
    name, maker = table.columns[columns[0]], maker_of(table)
    is_count = (values[np.isfinite(values)] % 1.0 == 0.0).all()
    counts = maker.get(f'count of {quantity}') if is_count else None
    if known := counts or maker.get(quantity) or _rate_above(table, quantity):
        said = f'{name} is in {known}, as of {maker.get("maker", "the lines above")}'
        return values * table.known_factor(quantity, known), said
    for told in gravity_in(values) if quantity == 'acceleration' else ():
        said = f'no unit of {name} in the header: taken in {told}, as gravity is in it'
        return values * _UNITS[told], said if told else ''
    unit, most, other, most_in_other, share = TOLD_BY_SIZE[quantity]
    compared = values
    if quantity == 'tilt':  # a table has all of its angles in one unit
        angles = [i for i, each in enumerate(table.columns) if ANGLES.search(folded(each))]
        compared = table.values(angles).reshape(-1, 1)
    size = _size(compared, share)
    if most < size <= most_in_other and not is_count:
        said = f'no unit of {name} in the header: taken in {other}, as it is up to {size:.4g}'
        return values * table.known_factor(quantity, other), said
    if size > most and is_scale_needed:
        of = 'at most' if most_in_other else 'as a median'
        raise table.error(
            f'{name} without a unit is {size:.4g} {of}, which is no {unit}',
            cure=f'give its unit, as {name} [{other}]',
        )
    note = f'no unit of {name} in the header: taken in {unit}; call it {name} [{other}] if it is'
    return values, note


def _rate_above(table: TextTable, quantity: str) -> str:
    """Return the unit of an angular rate that the lines above tell, as of its range."""
    words = ' '.join(table.above).split() if quantity == 'rate' else ()
    found = {word for each in words if unit_known('rate', word := each.strip('()[],;'))}
    return found.pop() if len(found) == 1 else ''


def sample_times(table: TextTable, times: Times, column: int | None) -> Times:
    """
    Return the times of samples, in that unit in which they are as far apart as usual.

    A `FormatError` refuses those that are too far apart or too close.
    """
    steps = np.diff(times.seconds[np.isfinite(times.seconds)])
    step = float(np.median(steps)) if len(steps) else 0.0
    name = '' if column is None else table.columns[column]
    has_unit = column is None or table.unit_of(column, 'time') or 'sec' in name.lower()
    is_dated = (times.epoch or 0.0) > _OLDEST
    for unit, factor in () if has_unit or is_dated else _FINER.items():
        if step > _SLOWEST and _USUAL_STEP[0] <= step * factor < _USUAL_STEP[1]:
            note = f'no unit of {name} in the header: taken in {unit}, a sample every {step:.4g}'
            return Times(times.seconds * factor, None, note)
    if step > _SLOWEST or 0.0 < step <= _SHORTEST:
        size = 'few to tell how a tree sways' if step > _SLOWEST else 'many for a motion sensor'
        raise table.error(
            f'a sample every {step:.6g} s, too {size}',
            cure='name the unit of time, as time [ms]; a sensor sends 20 samples per second or '
            'more',
        )
    return times
