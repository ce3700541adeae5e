# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Tables of the motion of a tree.

A time column (``time``, ``t``, ``timestamp`` ...) in seconds, in another unit behind the name
(``time [ms]``) or as ISO 8601 dates, and one to three columns of displacement, tilt, angular rate
or acceleration: ``x``, ``y``, ``z``, ``displacement``, ``tilt_x``, ``ax``, ``roll`` ... A unit may
follow the name: ``x [mm]``, ``tilt_x (deg)``, ``ax [g]``. Units only scale the columns, as
frequency and damping do not depend on them. Comma, semicolon or tab between cells; lines with #
are comments. Other columns are ignored. A row that is not a number is never replaced: a few are
gaps and counted, else the first is refused with its line.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.files.layouts.known import table_of
from tree_sway.files.motion.motion_columns import in_si, motions_of, sample_times
from tree_sway.files.motion.motion_record import AXES
from tree_sway.files.motion.motion_table import read_motion_table
from tree_sway.files.paths import of_file
from tree_sway.files.row_times import by_own_clock, counted_times, row_times, time_columns
from tree_sway.files.table_file import TextTable
from tree_sway.files.time_stamps import Times
from tree_sway.files.zipped import tables_in

_MAX_VALUE = 1e12
"""Largest time or motion in any unit."""
_OF_AN_IMU = ('acceleration', 'rate', 'tilt', 'orientation')
"""Quantities that one sensor measures, all at the same frequencies; the first is taken."""


@dataclass(frozen=True, eq=False)
class SwayRecord:
    """
    Motion of a tree over time.

    Parameters
    ----------
    time
        Time of each sample in [s], as in the file, (n,).
    motion
        One column per axis, (n, c), in [m], [rad], [rad/s] or [m/s^2].
    quantity
        ``displacement``, ``tilt``, ``rate`` or ``acceleration``.
    columns
        Names of the columns in the file.
    source
        Name of the file.
    notes
        Choices of the reader, one sentence each.

    """

    time: Floats
    motion: Floats
    quantity: str
    columns: tuple[str, ...]
    source: str
    notes: tuple[str, ...] = ()


@of_file
def read_csv_sway(path: Path, most_gaps: float = 0.1) -> SwayRecord:
    """
    Read the motion of a tree from a table, as `parse_sway`, or from a phone's zip of several.

    ``most_gaps`` is the share of rows that may have no number: they are gaps in the times.
    """
    if path.suffix.lower() != '.zip':
        source, lines = next(tables_in(path))
        return parse_sway(lines, source, most_gaps)
    found = read_motion_table(path)
    quantity = next(each for each in AXES if getattr(found, each) is not None)
    motion, axes = getattr(found, quantity), tuple(AXES[quantity])
    return SwayRecord(found.time, motion, quantity, axes, found.source, found.notes)


def parse_sway(lines: list[str], source: str, most_gaps: float = 0.0) -> SwayRecord:
    """
    Return the motion of a tree from the lines of a table.

    ``most_gaps`` is the share of rows that may have no number.

    Raises
    ------
    FormatError
        No time or no motion among the columns, an unknown unit, two quantities in one file other
        than those of an IMU, of which the acceleration is taken, or a cell that is not a finite
        number.

    """
    table = table_of(lines, source)
    clock = time_columns(table)
    # Sensor Logger has axes x, y, z for all its sensors.
    is_logged = 'seconds_elapsed' in table.columns
    groups = motions_of(table, 'acceleration' if is_logged else 'displacement')
    counted = counted_times(table) if clock is None else None
    if (clock or counted) is None or not groups:
        raise table.error(
            f'no {"motion" if clock or counted else "time"} among {", ".join(table.columns[:20])}',
            cure='call the columns time, x, y or time, tilt_x or time, ax, ay in the header',
        )
    quantities = sorted({quantity for quantity, _ in groups})
    quantity = next((each for each in _OF_AN_IMU if each in quantities), quantities[0])
    if len(quantities) > 1 and not {*quantities} <= {*_OF_AN_IMU}:
        names = (table.columns[each] for axes in groups.values() for each in axes.values())
        raise table.error(
            f'{" and ".join(quantities)} in one file',
            cure=f'keep the columns of one quantity, of {", ".join(names)}',
        )
    motion = next([*axes.values()] for (each, _), axes in groups.items() if each == quantity)
    if clock is not None:
        table, clock = by_own_clock(table, clock, motion)
    columns = [table.columns[each] for each in motion]
    kept = np.flatnonzero(np.isfinite(table.values(motion)).all(axis=1))
    n_gaps = len(table.rows) - len(kept)
    if n_gaps <= most_gaps * len(table.rows):
        table = table.part(kept)
        counted = counted and counted._replace(seconds=counted.seconds[kept])
    values = table.strict(columns)
    with np.errstate(over='ignore'):
        motion_si, note = in_si(table, motion, quantity, is_scale_needed=False)
    for row, column in np.argwhere(np.abs(motion_si) > _MAX_VALUE)[:1]:
        raise table.error(
            f'{columns[column]} is {values[row, column]:.3g}, which is implausible',
            row,
            'correct the cell or remove the row',
        )
    times = _times(table, *clock) if clock else counted
    assert times is not None
    gaps = f'{n_gaps} rows without a number are left out' if n_gaps else ''
    notes = tuple(filter(None, (gaps, note, times.note)))
    return SwayRecord(times.seconds, motion_si, quantity, tuple(columns), source, notes)


def _times(table: TextTable, columns: Sequence[int], form: str, factor: float) -> Times:
    """Return the times of the rows, which are numbers or dates that rise."""
    times = row_times(table, columns, form, factor, table.rows)
    stamps = table.cells(columns[0], table.rows)
    for row in np.flatnonzero(~(np.abs(times.seconds) <= _MAX_VALUE))[:1]:
        raise table.error(
            f"time is '{stamps[row][:40]}', neither seconds nor a date",
            row,
            'correct the cell or remove the row',
        )
    for row in np.flatnonzero(np.diff(times.seconds) <= 0.0)[:1]:
        raise table.error(
            f'time {stamps[row + 1][:40]} does not come after {stamps[row][:40]}',
            row + 1,
            'put the rows in the order of time, each time once',
        )
    return sample_times(table, times, columns[0])
