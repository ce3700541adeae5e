# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Tables of a motion sensor: a time, and three columns of acceleration or angular rate, or both.

``time,ax,ay,az,gx,gy,gz``, the exports of phyphox (``"Acceleration x (m/s^2)"``, ``"Gyroscope x
(rad/s)"``) and others with units behind their names; axes that are called ``x``, ``y`` and ``z``
are known by their unit (``x-axis (g)``). An orientation has the columns ``qx``, ``qy``, ``qz`` and
``qw``. A cell that is no number is kept as not a number, so that the sensor refuses and counts its
row.
"""

from __future__ import annotations

from pathlib import Path
import re

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.arrays import Floats
from tree_sway.files.column_names import folded, MOTIONS, unit_factor
from tree_sway.files.motion.motion_record import MotionRecord
from tree_sway.files.table_file import parse_table, TextTable
from tree_sway.files.text_file import read_table_lines
from tree_sway.files.time_stamps import Times
from tree_sway.files.wind.row_times import row_times, time_columns

_AXES = 'xyz'
_BARE_AXIS = re.compile(r'([xyz])(?:[ _-]?axis)?')
_ORIENTATION = ('qx', 'qy', 'qz', 'qw')
_DEVICES = frozenset({'devicename', 'device', 'deviceid', 'sensorname', 'sensorid', 'address'})
"""Names of columns that tell which of several sensors a row is of."""
_SLOWEST = 1.0
"""Longest time between samples that may tell a sway in [s]."""
_NAMES = (
    'call the columns time or time [ms], ax, ay, az, and gx, gy, gz for an angular rate, or give '
    'x, y, z a unit, as x [m/s^2]'
)


def read_motion_table(path: Path) -> MotionRecord:
    """
    Read a table of a motion sensor.

    Raises
    ------
    FormatError
        No time, no three axes of acceleration or angular rate and no orientation, an unknown
        unit, rows of several sensors, or times that cannot be those of samples.

    """
    table = parse_table(read_table_lines(path), str(path))
    names = [name for name, _ in table.headings]
    clock = time_columns(table)
    picked = {quantity: _axes(table, names, quantity) for quantity in ('acceleration', 'rate')}
    if all(each in names for each in _ORIENTATION):
        picked['orientation'] = [names.index(each) for each in _ORIENTATION]
    if clock is None or not any(picked.values()):
        what = f'no {"time" if clock is None else "motion"} among {", ".join(table.columns[:20])}'
        raise table.error(what, cure=_NAMES)
    _refuse_several(table, names)
    times = row_times(table, *clock, list(range(len(table.texts))))
    values = {
        quantity: table.values(columns) * [table.factor(each, quantity) for each in columns]
        for quantity, columns in picked.items()
        if columns
    }
    first_cell = table.cells(clock[0][0], [0])[0]
    _refuse_times(table, times, np.hstack(list(values.values())), first_cell)
    read = ', '.join(table.columns[each] for columns in picked.values() for each in columns)
    notes = [f'{path.name}: read {read}', *([times.note] if times.note else [])]
    return MotionRecord(
        np.asarray(times.seconds),
        values.get('acceleration'),
        values.get('rate'),
        values.get('orientation'),
        str(path),
        times.epoch,
        tuple(notes),
    )


def _axes(table: TextTable, names: list[str], quantity: str) -> list[int]:
    """Three columns of a quantity, by their names or else by their unit; none without all."""
    found = [
        next((i for i, name in enumerate(names) if _is_axis(name, quantity, axis)), None)
        for axis in _AXES
    ]
    if None in found:
        bare = {
            axis[1]: i
            for i, (name, unit) in enumerate(table.headings)
            if (axis := _BARE_AXIS.fullmatch(name)) and unit and unit_factor(quantity, unit)
        }
        found = [bare.get(axis) for axis in _AXES]
    columns = [each for each in found if each is not None]
    return columns if len(columns) == len(_AXES) else []


def _is_axis(name: str, quantity: str, axis: str) -> bool:
    return name.endswith(axis) and MOTIONS[quantity].fullmatch(name) is not None


def _refuse_several(table: TextTable, names: list[str]) -> None:
    """Refuse a table with rows of several sensors."""
    for column, name in enumerate(names):
        if folded(name) in _DEVICES:
            cells = table.cells(column, range(len(table.texts)))
            found = sorted({*cells} - {'', table.columns[column]})
            if len(found) > 1:
                what = f'rows of {len(found)} sensors: {", ".join(found[:4])}'
                raise table.error(what, cure='write a table for each, and give each its place')


def _refuse_times(table: TextTable, times: Times, values: Floats, first_cell: str) -> None:
    """Refuse times that are none, go back, stand still or are too far apart for samples."""
    seconds = times.seconds
    is_time = np.isfinite(seconds)
    if not is_time.any():
        what = f"no time in any row: the first is '{first_cell[:40]}'"
        raise table.error(what, cure='give seconds or dates')
    rows = np.flatnonzero(is_time)
    steps = np.diff(seconds[rows])
    if _are_most(steps < 0.0, 0.1):
        what = f'time goes back in {np.count_nonzero(steps < 0.0)} of {len(rows)} rows'
        raise table.error(what, cure='put the rows in the order of time')
    changes = (np.diff(values[rows], axis=0) != 0.0).any(axis=1)
    stands = (steps == 0.0) & changes
    if _are_most(stands, 0.5):
        what = f'{np.count_nonzero(stands)} of {len(rows)} rows have the time of the row before'
        raise table.error(what, cure='export times with fractions of a second')
    step = float(np.median(steps)) if len(steps) else 0.0
    if step > _SLOWEST:
        what = f'a sample every {step:.6g} s, too few to tell how a tree sways'
        cure = 'name the unit of time, as time [ms]; a sensor sends 20 samples per second or more'
        raise table.error(what, cure=cure)


def _are_most(rows: NDArray[np.bool_], share: float) -> bool:
    return bool(np.count_nonzero(rows) > share * max(len(rows), 1))
