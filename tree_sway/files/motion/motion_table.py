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

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.rotation import quaternion_rotated
from tree_sway.errors import FormatError
from tree_sway.files.column_names import FILES_OF, folded, SENDERS
from tree_sway.files.layouts.known import table_of
from tree_sway.files.makers import maker_of
from tree_sway.files.motion.motion_columns import (
    gravity_in,
    in_si,
    Motions,
    motions_of,
    sample_times,
)
from tree_sway.files.motion.motion_record import AXES, MotionRecord
from tree_sway.files.paths import of_file
from tree_sway.files.row_times import by_own_clock, counted_times, row_times, time_columns
from tree_sway.files.table_file import TextTable
from tree_sway.files.text_file import read_lines
from tree_sway.files.time_stamps import Times
from tree_sway.files.zipped import tables_in

_ABOUT = 'Metadata.csv'
"""File of Sensor Logger about the phone."""
_EARTH = re.compile('freeacc')
"""Accelerations of Xsens and Movella that are east, north, up."""
_NAMES = (
    'call the columns time or time [ms], ax, ay, az, and gx, gy, gz for an angular rate, or give '
    'x, y, z a unit, as x [m/s^2]'
)
_PARTIAL = (
    'give all three axes of one acceleration or angular rate; tilts, strains and single axes '
    'tell how fast the tree swings: tree-sway calibrate --record'
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
    motions = motions_of(table)
    picked = _axes(motions)
    every = [each for columns in picked.values() for each in columns]
    if clock is not None:
        table, clock = by_own_clock(table, clock, every)
    times = None if clock is None else row_times(table, *clock, table.rows)
    if times is None or not np.isfinite(times.seconds).any():
        times = counted_times(table) or times
    if times is None or not picked:
        what = f'no {"time" if times is None else "motion"} among {", ".join(table.columns[:20])}'
        if times and motions:
            raise table.error(f'{what}: none of a sensor with its three axes', cure=_PARTIAL)
        raise table.error(what, cure=_NAMES)
    column = None if clock is None else clock[0][0]
    times = _checked_times(table, times, table.values(every), column)
    found = {quantity: in_si(table, columns, quantity) for quantity, columns in picked.items()}
    values = {quantity: each for quantity, (each, _) in found.items()}
    read = ', '.join(table.columns[each] for each in every)
    order = ', the orientation as x, y, z, w' if 'orientation' in picked else ''
    notes = [f'{Path(source).name}: read {read}{order}', times.note]
    notes += [note for _, note in found.values()]
    if 'acceleration' in values and (maker_of(table).get('sign') == -1 or _is_of_apple(about)):
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
    has_gravity = record.acceleration is not None and '' in gravity_in(record.acceleration)
    is_raw = 'uncalibrated' in record.source.lower()
    return has_gravity, record.acceleration is not None, record.rate is not None, not is_raw


def _axes(motions: Motions) -> dict[str, list[int]]:
    """Columns of the axes of each quantity: of several with one name the first that has all."""
    picked: dict[str, list[int]] = {}
    for (quantity, _), axes in motions.items():
        wanted = AXES.get(quantity, '')
        names = wanted if axes.keys() >= set(wanted) else ''.join(sorted(axes))
        if wanted and len(names) == len(wanted) and (names == wanted or names.isdecimal()):
            picked.setdefault(quantity, [axes[axis] for axis in names])
    return picked


def _checked_times(table: TextTable, times: Times, values: Floats, column: int | None) -> Times:
    """
    Refuse times that are none, go back, stand still or are too far apart for samples.

    They are in the unit of `sample_times`.
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
    return sample_times(table, times, column)
