# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Tables of the motion of a tree.

A time column (``time``, ``t``, ``timestamp`` ...) in seconds, in another unit behind the name
(``time [ms]``) or as ISO 8601 dates, and one to three columns of displacement, tilt, angular rate
or acceleration: ``x``, ``y``, ``z``, ``displacement``, ``tilt_x``, ``ax``, ``roll`` ... A unit may
follow the name: ``x [mm]``, ``tilt_x (deg)``, ``ax [g]``. Units only scale the columns, as
frequency and damping do not depend on them. Comma, semicolon or tab between cells; lines with #
are comments. Other columns are ignored. A row that is not a number is refused with its line and
never replaced.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.files.column_names import motion_of
from tree_sway.files.layouts.known import table_of
from tree_sway.files.paths import of_file
from tree_sway.files.row_times import row_times, time_columns
from tree_sway.files.table_file import TextTable
from tree_sway.files.text_file import read_lines

_MAX_VALUE = 1e12
"""Largest time or motion in any unit."""


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

    """

    time: Floats
    motion: Floats
    quantity: str
    columns: tuple[str, ...]
    source: str


@of_file
def read_csv_sway(path: Path) -> SwayRecord:
    """Read the motion of a tree from a table, as `parse_sway`."""
    return parse_sway(read_lines(path), str(path))


def parse_sway(lines: list[str], source: str) -> SwayRecord:
    """
    Return the motion of a tree from the lines of a table.

    Raises
    ------
    FormatError
        No time or no motion among the columns, an unknown unit, two quantities in one file other
        than those of an IMU, of which the acceleration is taken, or a cell that is not a finite
        number.

    """
    table = table_of(lines, source)
    clock = time_columns(table)
    motion = [(i, found[0]) for i, name in enumerate(table.columns) if (found := motion_of(name))]
    if clock is None or not motion:
        raise table.error(
            f'no {"time" if clock is None else "motion"} among {", ".join(table.columns[:20])}',
            cure='call the columns time, x, y or time, tilt_x or time, ax, ay in the header',
        )
    if 'seconds_elapsed' in table.columns:  # Sensor Logger has axes x, y, z for all its sensors
        motion = [(i, 'acceleration' if q == 'displacement' else q) for i, q in motion]
    quantities = sorted({quantity for _, quantity in motion})
    if quantities == ['acceleration', 'rate']:  # of an IMU: both have the same frequencies
        motion = [(i, quantity) for i, quantity in motion if quantity == 'acceleration']
        quantities = ['acceleration']
    if len(quantities) > 1:
        raise table.error(
            f'{" and ".join(quantities)} in one file', cure='keep the columns of one quantity'
        )
    factors = [table.factor_of(i, quantities[0]) for i, _ in motion]
    columns = [table.columns[i] for i, _ in motion]
    values = table.strict(columns)
    with np.errstate(over='ignore'):
        is_plausible = np.abs(values) * factors <= _MAX_VALUE
    for row, column in np.argwhere(~is_plausible)[:1]:
        raise table.error(
            f'{columns[column]} is {values[row, column]:.3g}, which is implausible',
            row,
            'correct the cell or remove the row',
        )
    times = _times(table, *clock)
    return SwayRecord(times, values * factors, quantities[0], tuple(columns), source)


def _times(table: TextTable, columns: list[int], form: str, factor: float) -> Floats:
    """Seconds of each row, from numbers or from dates."""
    rows = table.rows
    times = row_times(table, columns, form, factor, rows).seconds
    stamps = table.cells(columns[0], rows)
    for row in np.flatnonzero(~(np.abs(times) <= _MAX_VALUE))[:1]:
        raise table.error(
            f"time is '{stamps[row][:40]}', neither seconds nor a date",
            row,
            'correct the cell or remove the row',
        )
    for row in np.flatnonzero(np.diff(times) <= 0.0)[:1]:
        raise table.error(
            f'time {stamps[row + 1][:40]} does not come after {stamps[row][:40]}',
            row + 1,
            'put the rows in the order of time, each time once',
        )
    return times
