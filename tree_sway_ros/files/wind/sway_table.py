"""
The motion of a tree in a table with a header.

A time column (``time``, ``t``, ``timestamp`` ...) in seconds, in another unit behind the name
(``time [ms]``) or as ISO 8601 dates, and one to three columns of displacement, tilt, angular rate
or acceleration: ``x``, ``y``, ``z``, ``displacement``, ``tilt_x``, ``ax``, ``roll`` ... A unit may
follow the name: ``x [mm]``, ``tilt_x (deg)``, ``ax [g]``. Units only bring the columns to one
scale, as frequency and damping do not depend on it. Comma, semicolon or tab between cells; lines
with # are comments. Other columns are left alone. A row that is no number is refused with its line
and never filled in.

"""

from __future__ import annotations

import re
from dataclasses import dataclass
from math import pi
from pathlib import Path

import numpy as np

from tree_sway_ros.core.arrays import Floats
from tree_sway_ros.errors import FormatError
from tree_sway_ros.files.table_file import TextTable, parse_table, row_numbers
from tree_sway_ros.files.text_file import finite, read_lines
from tree_sway_ros.files.time_stamps import seconds_of_stamps
from tree_sway_ros.files.wind.units import TIME_UNITS, unit_factor

_TIME = ("time", "t", "timestamp", "stamp", "datetime", "date_time", "seconds", "secs", "elapsed")
_QUANTITY = {
    "displacement": re.compile(
        r"(displacement|disp|deflection|position|pos|d|u)(_?[xyz123])?|[xyz]"
    ),
    "tilt": re.compile(r"(tilt|inclination|angle|rotation|r)(_?[xyz123])?|roll|pitch|yaw"),
    "rate": re.compile(r"(gyro|rate|angular_velocity|angular_rate|omega|w|g)_?[xyz123]|gyro|rate"),
    "acceleration": re.compile(r"(acceleration|accel|acc|a)(_?[xyz123])?"),
}
_UNITS = {
    "displacement": {"m": 1.0, "cm": 0.01, "mm": 0.001},
    "tilt": {"rad": 1.0, "mrad": 1e-3, "deg": pi / 180.0, "degrees": pi / 180.0, "°": pi / 180.0},
    "rate": {"rad/s": 1.0, "deg/s": pi / 180.0, "°/s": pi / 180.0, "dps": pi / 180.0},
    "acceleration": {
        **{"m/s^2": 1.0, "m/s2": 1.0, "m/s²": 1.0, "m s-2": 1.0, "mm/s^2": 1e-3},
        **{"g": 9.80665, "mg": 9.80665e-3},
    },
}
_NAME = re.compile(r"[a-z_ ]*[a-z_0-9]+", re.IGNORECASE)
_UNIT = re.compile(r"\[(.*)\]|\((.*)\)|")
MAX_VALUE = 1e12
"""Larger times and motions are no measured ones, in whichever unit."""


@dataclass(frozen=True, eq=False)
class SwayRecord:
    """
    Motion of a tree over time.

    Parameters
    ----------
    time
        Of each sample in [s], as in the file, (n,).
    motion
        One column an axis, (n, c), in [m], [rad], [rad/s] or [m/s^2].
    quantity
        ``displacement``, ``tilt``, ``rate`` or ``acceleration``.
    columns
        Names of the columns in the file.
    source
        The file.

    """

    time: Floats
    motion: Floats
    quantity: str
    columns: tuple[str, ...]
    source: str


def read_csv_sway(path: Path) -> SwayRecord:
    """
    Read the motion of a tree from a table.

    Parameters
    ----------
    path
        The file.

    Raises
    ------
    FormatError
        No time or no motion among the columns, an unknown unit, two quantities in one file, or a
        cell that is no finite number.

    """
    source = str(path)
    table = parse_table(read_lines(path), source)
    headings = [_heading(column) for column in table.columns]
    clock = next((i for i, (name, _) in enumerate(headings) if name in _TIME), None)
    motion = [(i, q) for i, (name, _) in enumerate(headings) if (q := _quantity(name)) is not None]
    if clock is None or not motion:
        raise FormatError(
            f"no {'time' if clock is None else 'motion'} among {', '.join(table.columns[:20])}",
            where=f"{source}:1",
            cure="name the columns time, x, y or time, tilt_x, tilt_y or time, ax, ay in the "
            "header",
        )
    quantities = sorted({quantity for _, quantity in motion})
    if len(quantities) > 1:
        raise FormatError(
            f"{' and '.join(quantities)} in one file",
            where=f"{source}:1",
            cure="keep the columns of one quantity",
        )
    units = _UNITS[quantities[0]]
    factors = [unit_factor(units, headings[i][1], 1.0, f"{source}:1") for i, _ in motion]
    indices = [i for i, _ in motion]
    names = [table.columns[i] for i in indices]
    values = [row_numbers(cells, indices, names, f"{source}:{line}") for line, cells in table.rows]
    motion_values = np.array(values) * factors
    for row, column in np.argwhere(np.abs(motion_values) > MAX_VALUE)[:1]:
        raise FormatError(
            f"{names[column]} is {values[row][column]:.3g}, which nothing measures",
            where=f"{source}:{table.rows[row][0]}",
            cure="mend the cell or remove the row",
        )
    return SwayRecord(
        _times(table, clock, headings[clock][1]),
        motion_values,
        quantities[0],
        tuple(names),
        source,
    )


def _heading(column: str) -> tuple[str, str]:
    """Name in lower case, with _ for spaces, and unit of a column."""
    begin = min((i for c in "[(" if (i := column.find(c)) >= 0), default=len(column))
    name, unit = column[:begin].strip(), _UNIT.fullmatch(column[begin:].strip())
    if unit is None or _NAME.fullmatch(name) is None:
        return "", ""
    return name.lower().replace(" ", "_"), (unit[1] or unit[2] or "").strip()


def _quantity(name: str) -> str | None:
    return next((q for q, pattern in _QUANTITY.items() if pattern.fullmatch(name)), None)


def _times(table: TextTable, clock: int, unit: str) -> Floats:
    """Seconds of each row, from numbers or from dates."""
    stamps = [cells[clock] if clock < len(cells) else "" for _, cells in table.rows]
    numbers = [finite(stamp) for stamp in stamps]
    if any(number is not None for number in numbers):
        factor = unit_factor(TIME_UNITS, unit, 1.0, f"{table.source}:1")
        times = np.array([np.nan if n is None else n * factor for n in numbers])
    else:
        times = seconds_of_stamps(stamps)[0]
    for row in np.flatnonzero(~(np.abs(times) <= MAX_VALUE))[:1]:
        raise FormatError(
            f"time is '{stamps[row][:40]}', neither seconds nor a date",
            where=f"{table.source}:{table.rows[row][0]}",
            cure="mend the cell or remove the row",
        )
    for row in np.flatnonzero(np.diff(times) <= 0.0)[:1]:
        raise FormatError(
            f"time {stamps[row + 1][:40]} does not come after {stamps[row][:40]}",
            where=f"{table.source}:{table.rows[row + 1][0]}",
            cure="put the rows in the order of time, each time once",
        )
    return times
