"""
Wind in a table with a header.

A time column (``time``, ``t``, ``timestamp``, ``stamp`` ...) in seconds or as ISO 8601 dates, and
either components ``u, v`` and perhaps ``w`` (or ``x, y, z``), or ``speed`` and ``direction`` in
degrees clockwise from north. A unit may follow the name: ``speed [km/h]``, ``u (m/s)``,
``time_ms``, ``direction_deg``. Components point where the wind blows to, a direction says where it
comes from, as is the use of each; ``direction_convention`` says otherwise. Comma, semicolon or tab
between cells; lines with # are comments.

"""

from __future__ import annotations

import re
from array import array
from dataclasses import dataclass
from math import pi
from pathlib import Path

from tree_sway_ros.core.wind.convention import WindConvention, velocity_of_bearing
from tree_sway_ros.errors import FormatError
from tree_sway_ros.files.table_file import TextTable, parse_table
from tree_sway_ros.files.text_file import finite, read_lines, why_no_number
from tree_sway_ros.files.time_stamps import seconds_of_stamps
from tree_sway_ros.files.wind.record import WindRecord, WindRows
from tree_sway_ros.files.wind.units import (
    ANGLE_UNITS,
    SPEED_UNITS,
    TIME_UNITS,
    unit_factor,
)

_TIME = ("time", "t", "timestamp", "stamp", "datetime", "date_time", "seconds", "secs")
_U = ("u", "x", "ux", "east", "vx", "velocity_x", "wind_u", "wind_x")
_V = ("v", "y", "uy", "north", "vy", "velocity_y", "wind_v", "wind_y")
_W = ("w", "z", "uz", "up", "vz", "velocity_z", "wind_w", "wind_z")
_SPEED = ("speed", "wind_speed", "windspeed", "ws", "wspd")
_DIRECTION = (
    "direction",
    "dir",
    "wind_direction",
    "winddirection",
    "wind_dir",
    "winddir",
    "wd",
    "wdir",
)


@dataclass(frozen=True, slots=True)
class _Column:
    index: int
    factor: float


def read_csv_wind(
    path: Path, direction_convention: str | None = None, yaw: float = 0.0
) -> WindRecord:
    """
    Read the wind of a table.

    Parameters
    ----------
    path
        The file.
    direction_convention
        ``to`` or ``from``; None for ``to`` with components and ``from`` with a direction.
    yaw
        From east to the sensor's x axis, counter-clockwise, in [rad]; for a direction, from north
        to the sensor's zero, likewise counter-clockwise.

    Raises
    ------
    FormatError
        A column that is missing, a unit that is not known, or no good row.

    """
    if direction_convention is not None:
        WindConvention(direction_convention)  # refused before the file is read
    source = str(path)
    table = parse_table(read_lines(path), source)
    time = _column(table, _TIME, TIME_UNITS, 1.0)
    u, v = _column(table, _U, SPEED_UNITS, 1.0), _column(table, _V, SPEED_UNITS, 1.0)
    w = _column(table, _W, SPEED_UNITS, 1.0)
    speed = _column(table, _SPEED, SPEED_UNITS, 1.0)
    direction = _column(table, _DIRECTION, ANGLE_UNITS, pi / 180.0)
    if time is None or ((u is None or v is None) and (speed is None or direction is None)):
        raise FormatError(
            f"no time with u and v, or with speed and direction, among "
            f"{', '.join(table.columns[:20])}",
            where=f"{source}:1",
            cure="name the columns so in the header",
        )
    rows, stamps = WindRows(source), list[str]()
    chosen = [c for c in ((u, v, w) if u and v else (speed, direction)) if c is not None]
    for number, cells in table.rows:
        values = _values(table, cells, chosen)
        if isinstance(values, str) or time.index >= len(cells):
            rows.refuse(number, values if isinstance(values, str) else "no time")
            continue
        stamps.append(cells[time.index])
        if u and v:
            rows.add(number, 0.0, (values[0], values[1], values[2] if w else 0.0))
        elif values[0] < 0.0:
            rows.refuse(number, f"speed is {values[0]:g}")
            stamps.pop()
        else:
            bearing = values[1] - yaw
            rows.add(
                number, 0.0, velocity_of_bearing(values[0], bearing, direction_convention or "from")
            )
    seconds, epoch = _times(stamps, time.factor)
    rows.time = array("d", seconds)
    if u and v:
        convention = direction_convention or "to"
        return rows.record(epoch=epoch, yaw=yaw, direction_convention=convention)
    return rows.record(epoch=epoch)


def _values(table: TextTable, cells: tuple[str, ...], columns: list[_Column]) -> list[float] | str:
    """Values in SI of some cells, or why not."""
    values = []
    for column in columns:
        cell = cells[column.index] if column.index < len(cells) else ""
        value = finite(cell)
        if value is None:
            return f"{table.columns[column.index]} is {why_no_number(cell)}"
        values.append(value * column.factor)
    return values


def _times(stamps: list[str], factor: float) -> tuple[list[float], float | None]:
    """Seconds, and what they count from if the stamps are dates; NaN where a stamp is neither."""
    numbers = [finite(stamp) for stamp in stamps]
    if any(number is not None for number in numbers):
        return [float("nan") if n is None else n * factor for n in numbers], None
    seconds, epoch = seconds_of_stamps(stamps)
    return seconds.tolist(), epoch


def _column(
    table: TextTable, names: tuple[str, ...], units: dict[str, float], default: float
) -> _Column | None:
    """Return the first column of one of these names, with or without a unit behind it."""
    for name in names:
        pattern = re.compile(rf"{name}\s*(?:\[(.*)\]|\((.*)\)|_(.+))?", re.IGNORECASE)
        for index, column in enumerate(table.columns):
            match = pattern.fullmatch(column)
            if match is None:
                continue
            suffix = match[3]
            if suffix is not None and suffix.lower() not in units:
                continue  # another quantity that begins alike, as u_std
            unit = match[1] or match[2] or suffix or ""
            factor = unit_factor(units, unit, default, f"{table.source}:1")
            return _Column(index, factor)
    return None
