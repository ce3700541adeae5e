# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Tables of a motion sensor: a time, and three columns of acceleration or angular rate, or both.

``time,ax,ay,az,gx,gy,gz``, the exports of phyphox (``"Acceleration x (m/s^2)"``, ``"Gyroscope x
(rad/s)"``) and others with units behind their names, in any layout of `layouts.known`. Axes ``x``,
``y`` and ``z`` are known by their unit (``x-axis (g)``), by the name of the file
(``Gyroscope.csv``), or by gravity, which tells a missing unit of accelerations too. An orientation
has the columns ``qx``, ``qy``, ``qz`` and ``qw``. A cell that is no number is kept as not a
number, so that the sensor refuses and counts its row.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
import re
from typing import Any

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.rotation import quaternion_rotated
from tree_sway.errors import FormatError
from tree_sway.files.column_names import (
    FILES_OF,
    folded,
    motion_of,
    name_and_unit,
    SENDERS,
    unit_known,
)
from tree_sway.files.layouts.known import table_of
from tree_sway.files.makers import maker_of
from tree_sway.files.motion.motion_record import AXES, MotionRecord
from tree_sway.files.paths import of_file
from tree_sway.files.row_times import counted_times, row_times, time_columns
from tree_sway.files.table_file import TextTable
from tree_sway.files.text_file import read_lines
from tree_sway.files.time_stamps import Times
from tree_sway.files.zipped import tables_in

_VECTORS = ('rate', 'acceleration')
_BARE_AXIS = re.compile(r'(?:axis)?([xyz])(?:axis|value)?')
_ABOUT = 'Metadata.csv'
"""File of Sensor Logger about the phone."""
_EARTH = re.compile('freeacc')
"""Accelerations of Xsens and Movella that are east, north, up."""
_GRAVITY = (8.5, 11.2)
"""Range of the median of accelerations with gravity [m/s^2]."""
_UNITS = {'': 1.0, 'g': 9.80665, 'mg': 0.00980665, 'mm/s^2': 0.001}
"""Units that gravity tells, of which none is that of SI."""
_FASTEST = 35.0
"""Largest angular rate that a sensor measures [rad/s]: 2,000 degrees per second."""
_LARGEST = 0.999
"""Share of the rates that the largest exceeds: a few more may be faults."""
_SLOWEST = 1.0
"""Longest time between samples that may tell a sway in [s]."""
_OLDEST = 946_684_800.0
"""Date before which a number is no time since 1970: 2000-01-01 [s]."""
_FINER = {'ms': 1e-3, 'us': 1e-6, 'ns': 1e-9}
_USUAL_STEP = (2e-3, 0.2)
"""Times between samples that tell the unit of their times in [s]."""
_SHORTEST = 5e-4
"""Time between samples that no motion sensor falls below [s]."""
_NAMES = (
    'call the columns time or time [ms], ax, ay, az, and gx, gy, gz for an angular rate, or give '
    'x, y, z a unit, as x [m/s^2]'
)


@of_file
def read_motion_table(path: Path) -> MotionRecord:
    """
    Read a table of a motion sensor, or the tables of a zip, such as a phone's.

    Raises
    ------
    FormatError
        No time, no three axes of acceleration or angular rate and no orientation, an unknown
        unit, rows of several sensors, or times or values that cannot be those of samples.

    """
    records = list[MotionRecord]()
    failures = list[FormatError]()
    lines_of = dict(tables_in(path))
    beside = path.with_name(_ABOUT)
    if len(lines_of) == 1 and beside.is_file() and beside != path:
        about = read_lines(beside)
    else:
        about = next((each for name, each in lines_of.items() if name.endswith(_ABOUT)), [])
    for name, lines in lines_of.items():
        try:
            records += [_record(table, about) for table in _by_sensor(table_of(lines, name))]
        except FormatError as error:
            failures.append(error)
    if not records:
        raise min(failures, key=lambda error: error.what.startswith('no '))
    return _joined(records, str(path))


def _by_sensor(table: TextTable) -> list[TextTable]:
    """Return the rows of each sensor of motion, where a column names it, as tables of files."""
    moves = {quantity: words for quantity, words in FILES_OF.items() if quantity}
    for index, column in enumerate(table.columns):
        rows = table.rows_by(index) if folded(column) in SENDERS else {}
        told = [each for each in rows if any(w.search(folded(each)) for w in moves.values())]
        if len(told) > 1 and min(len(rows[each]) for each in told) > 1:
            return [table.part(rows[each], f'/{each}') for each in sorted(told)]
    return [table]


def _record(table: TextTable, about: Sequence[str]) -> MotionRecord:
    """Return the motion of a table; lines tell about the phone."""
    source = table.source
    table.refuse_several()
    clock = time_columns(table)
    picked = _axes(table, folded(Path(source).stem))
    times = None if clock is None else row_times(table, *clock, table.rows)
    if times is None or not np.isfinite(times.seconds).any():
        times = counted_times(table) or times
    if times is None or not picked:
        raise table.error(
            f'no {"time" if times is None else "motion"} among {", ".join(table.columns[:20])}',
            cure=_NAMES,
        )
    values = {quantity: table.values(columns) for quantity, columns in picked.items()}
    column = None if clock is None else clock[0][0]
    times = _checked_times(table, times, np.hstack(list(values.values())), column)
    read = ', '.join(table.columns[each] for columns in picked.values() for each in columns)
    notes = [f'{Path(source).name}: read {read}', times.note]
    maker = maker_of(table)
    for quantity, columns in picked.items():
        factors = np.array([table.factor_of(each, quantity) for each in columns])
        if quantity != 'orientation' and not table.unit_of(columns[0], quantity):
            factors[:], note = _without_unit(table, maker, columns[0], quantity, values[quantity])
            notes.append(note)
        values[quantity] = values[quantity] * factors
    if 'acceleration' in values and (maker.get('sign') == -1 or _is_of_apple(about)):
        values['acceleration'] = -values['acceleration']
        notes.append('accelerations are turned about, as those of Apple point as gravity does')
    if _EARTH.match(folded(table.columns[picked.get('acceleration', [0])[0]])):
        notes.append(_turn_from_earth(values))
    return MotionRecord(
        np.asarray(times.seconds),
        values.get('acceleration'),
        values.get('rate'),
        values.get('orientation'),
        source,
        times.epoch,
        tuple(filter(None, notes)),
    )


def _is_of_apple(about: Sequence[str]) -> bool:
    """Whether Sensor Logger's lines about a phone say that it is Apple's, with its own signs."""
    told = dict(zip(*(line.split(',') for line in about[:2]), strict=False)) if about[1:] else {}
    return told.get('platform') == 'ios' and told.get('standardisation') != 'true'


def _turn_from_earth(values: dict[str, Floats]) -> str:
    """Turn accelerations east, north, up to the sensor's frame, and return what was done."""
    if 'orientation' not in values:
        return 'accelerations are east, north, up, as no orientation tells the frame of the sensor'
    inverse = values['orientation'][:, [3, 0, 1, 2]] * [1.0, -1.0, -1.0, -1.0]
    values['acceleration'] = quaternion_rotated(inverse, values['acceleration'])
    return "accelerations east, north, up are turned to the sensor's frame by its orientation"


def _joined(records: Sequence[MotionRecord], source: str) -> MotionRecord:
    """
    Return the quantities of the tables of a phone at the times of one of them.

    That is one with gravity if there is one, else with an acceleration, else with a rate.
    """
    first = max(records, key=_worth)
    found = {quantity: getattr(first, quantity) for quantity in AXES}
    notes = list(first.notes)
    for each in records:
        for quantity in AXES:
            values = getattr(each, quantity)
            if found[quantity] is None and values is not None:
                are_dated = first.epoch is not None and each.epoch is not None
                clock = each.times_after(first.epoch) if are_dated else each.time
                axes = [np.interp(first.time, clock, axis, np.nan, np.nan) for axis in values.T]
                found[quantity] = np.column_stack(axes)
                notes += each.notes
    return replace(first, source=source, notes=tuple(notes), **found)


def _worth(record: MotionRecord) -> tuple[bool, ...]:
    has_gravity = record.acceleration is not None and '' in _gravity(record.acceleration)
    is_raw = 'uncalibrated' in record.source.lower()
    return has_gravity, record.acceleration is not None, record.rate is not None, not is_raw


def _axes(table: TextTable, stem: str) -> dict[str, list[int]]:
    """
    Columns of the axes of each quantity: of several with one name the first that has all.

    Those called x, y and z alone, where there are no others, are of the quantity of their unit, of
    the name of the file, or of an acceleration with gravity.
    """
    found: dict[tuple[str, str], dict[str, int]] = {}
    for index, column in enumerate(table.columns):
        bare = _BARE_AXIS.fullmatch(folded(name_and_unit(column, 'acceleration')[0]))
        quantity, name, axis = ('', '', bare[1]) if bare else motion_of(column) or ('', '', '')
        found.setdefault((quantity, name), {}).setdefault(axis, index)
    bare_axes = found.pop(('', ''), {})
    picked: dict[str, list[int]] = {}
    for (quantity, _), axes in found.items():
        wanted = AXES.get(quantity, '')
        names = wanted if axes.keys() >= set(wanted) else ''.join(sorted(axes))
        if wanted and len(names) == len(wanted) and (names == wanted or names.isdecimal()):
            picked.setdefault(quantity, [axes[axis] for axis in names])
    columns = [bare_axes[axis] for axis in 'xyz' if axis in bare_axes]
    if len(columns) == 3 and not picked:
        quantity = _quantity_of(table, columns, stem)
        picked |= {quantity: columns} if quantity else {}
    return picked


def _quantity_of(table: TextTable, columns: Sequence[int], stem: str) -> str:
    """Return what columns called x, y and z are; empty if nothing tells."""
    if any(table.unit_of(each, 'rate') for each in columns):
        units = [(each, table.unit_of(column, each)) for each in _VECTORS for column in columns]
        known = [each for each, unit in units if unit_known(each, unit)]
        return next((each for each in known if known.count(each) == len(columns)), '')
    named = [each for each, words in FILES_OF.items() if words.search(stem)]
    return named[0] if named else 'acceleration' if _gravity(table.values(columns)) else ''


def _gravity(values: Floats) -> tuple[str, ...]:
    """Return the unit of accelerations in which gravity is; nothing without it."""
    size = _size(values)
    units = _UNITS.items()
    return tuple(unit for unit, each in units if _GRAVITY[0] < size * each < _GRAVITY[1])


def _size(values: Floats, share: float = 0.5) -> float:
    """Return the length of vectors that a share of them stays below; 0 without one."""
    size = np.linalg.norm(values, axis=1)
    size = size[np.isfinite(size)]
    if not len(size):
        return 0.0
    return float(np.quantile(size, share, method='lower' if share == _LARGEST else 'linear'))


def _without_unit(
    table: TextTable, maker: dict[str, Any], column: int, quantity: str, values: Floats
) -> tuple[float, str]:
    """Factor to SI of values without a unit, and what was assumed; else a `FormatError`."""
    name = table.columns[column]
    if known := maker.get(quantity):
        return table.known_factor(quantity, known), f'{name} is in {known}, as of {maker["maker"]}'
    of_rate = ('rad/s', _FASTEST, 'deg/s')
    unit, most, other = ('m/s^2', _GRAVITY[1], 'g') if quantity == 'acceleration' else of_rate
    for told in _gravity(values) if quantity == 'acceleration' else ():
        said = f'no unit of {name} in the header: taken in {told}, as gravity is in it'
        return _UNITS[told], said if told else ''
    of, size = 'as a median', _size(values)
    if quantity == 'rate':
        of, size = 'at most', _size(values, _LARGEST)
        is_count = (values[np.isfinite(values)] % 1.0 == 0.0).all()
        if most < size <= np.degrees(most) and not is_count:
            said = f'no unit of {name} in the header: taken in deg/s, as it is up to {size:.4g}'
            return table.known_factor(quantity, 'deg/s'), said
    if size > most:
        raise table.error(
            f'{name} without a unit is {size:.4g} {of}, which is no {unit}',
            cure=f'give its unit, as {name} [{other}]',
        )
    note = f'no unit of {name} in the header: taken in {unit}; call it {name} [{other}] if it is'
    return 1.0, note


def _checked_times(table: TextTable, times: Times, values: Floats, column: int | None) -> Times:
    """
    Refuse times that are none, go back, stand still or are too far apart for samples.

    Those of a column without a unit are in that in which samples are as far apart as usual.
    """
    seconds = times.seconds
    is_time = np.isfinite(seconds)
    if not is_time.any():
        raise table.error(
            f"no time in any row: the first is '{table.cells(column or 0, [0])[0][:40]}'",
            cure='give seconds or dates',
        )
    rows = np.flatnonzero(is_time)
    steps = np.diff(seconds[rows])
    n_back = np.count_nonzero(steps < 0.0)
    if n_back > 0.1 * len(steps):
        raise table.error(
            f'time goes back in {n_back} of {len(rows)} rows',
            cure='put the rows in the order of time',
        )
    changes = (np.diff(values[rows], axis=0) != 0.0).any(axis=1)
    n_stand = np.count_nonzero((steps == 0.0) & changes)
    if n_stand > 0.5 * len(steps):
        raise table.error(
            f'{n_stand} of {len(rows)} rows have the time of the row before',
            cure='export times with fractions of a second, and one sensor alone',
        )
    step = float(np.median(steps)) if len(steps) else 0.0
    name = '' if column is None else table.columns[column]
    has_unit = column is None or table.unit_of(column, 'time') or 'sec' in name.lower()
    is_dated = (times.epoch or 0.0) > _OLDEST
    for unit, factor in () if has_unit or is_dated else _FINER.items():
        if step > _SLOWEST and _USUAL_STEP[0] <= step * factor < _USUAL_STEP[1]:
            note = f'no unit of {name} in the header: taken in {unit}, a sample every {step:.4g}'
            return Times(seconds * factor, None, note)
    if step > _SLOWEST or 0.0 < step <= _SHORTEST:
        size = 'few to tell how a tree sways' if step > _SLOWEST else 'many for a motion sensor'
        raise table.error(
            f'a sample every {step:.6g} s, too {size}',
            cure='name the unit of time, as time [ms]; a sensor sends 20 samples per second or '
            'more',
        )
    return times
