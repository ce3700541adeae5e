"""
Campbell Scientific TOA5: the table of a data logger with a sonic anemometer.

Four header lines: the logger, the column names, their units, how they were processed. The
components of a sonic, ``Ux Uy Uz``, point where the wind blows, in the axes of the instrument
(CSAT3 manual, 2.3); ``yaw`` turns them to east and north. A row with NAN or INF is refused.
Diagnostic words differ from instrument to instrument and are not read.

"""

from __future__ import annotations

from array import array
from pathlib import Path

import numpy as np

from tree_sway_ros.core.arrays import Floats
from tree_sway_ros.core.wind.convention import WindConvention
from tree_sway_ros.errors import FormatError
from tree_sway_ros.files.table_file import TextTable, split_row
from tree_sway_ros.files.text_file import finite, read_lines
from tree_sway_ros.files.time_stamps import seconds_of_stamps
from tree_sway_ros.files.wind.record import WindRecord, WindRows
from tree_sway_ros.files.wind.units import SPEED_UNITS, unit_factor

_BLOCK = 1 << 16
_COMPONENTS = (("Ux", "Uy", "Uz"), ("Ux_Avg", "Uy_Avg", "Uz_Avg"), ("U", "V", "W"))


def read_toa5_wind(
    path: Path,
    columns: tuple[str, str, str] | None = None,
    yaw: float = 0.0,
    direction_convention: str = "to",
) -> WindRecord:
    """
    Read the wind of a TOA5 table.

    Parameters
    ----------
    path
        The file.
    columns
        Names of the three components; ``Ux Uy Uz`` or a usual variant of them if None.
    yaw
        From east to the sonic's x axis, counter-clockwise, in [rad].
    direction_convention
        ``to`` where positive components blow to, ``from`` where they come from.

    Raises
    ------
    FormatError
        Not TOA5, no such columns, or no good row.

    """
    WindConvention(direction_convention)  # refused before the file is read
    source, lines = str(path), read_lines(path)
    if len(lines) < 4 or not lines[0].lstrip('"').startswith("TOA5"):
        raise FormatError("not TOA5: its 4 header lines are missing", where=f"{source}:1")
    header = TextTable(split_row(lines[1], ","), (), source)
    stamp_column = header.column_index("TIMESTAMP")
    names = columns or _components_of(header)
    indices = [header.column_index(name) for name in names]
    units = split_row(lines[2], ",")
    scale = [
        unit_factor(SPEED_UNITS, units[i] if i < len(units) else "", 1.0, f"{source}:3")
        for i in indices
    ]
    rows, stamps = WindRows(source), list[str]()
    for begin in range(4, len(lines), _BLOCK):
        block = lines[begin : begin + _BLOCK]
        filled = [row for row, line in enumerate(block) if line.strip()]
        block = [block[row] for row in filled]
        if not block:
            continue
        numbers = begin + 1 + np.array(filled, dtype=np.int64)
        values = _values(block, indices)
        good = np.isfinite(values).all(axis=1)
        for row in np.flatnonzero(~good):
            rows.refuse(int(numbers[row]), _reason(split_row(block[row], ","), indices, names))
        stamps += [_cell(block[row], stamp_column) for row in np.flatnonzero(good)]
        rows.add_block(numbers[good], values[good] * scale)
    seconds, epoch = seconds_of_stamps(stamps)
    rows.time = array("d", seconds)
    return rows.record(epoch=epoch, yaw=yaw, direction_convention=direction_convention)


def _values(block: list[str], indices: list[int]) -> Floats:
    """Cells of some columns as numbers, NaN where a cell is none, (n, 3)."""
    try:
        values = np.loadtxt(
            block, delimiter=",", usecols=indices, quotechar='"', comments=None, ndmin=2
        )
    except ValueError:
        values = np.empty((0, 3))
    if len(values) == len(block):
        return values
    # Somewhere is a row that numpy does not take: one by one, then.
    values = np.full((len(block), len(indices)), np.nan)
    for row, line in enumerate(block):
        cells = split_row(line, ",")
        for column, index in enumerate(indices):
            number = finite(cells[index]) if index < len(cells) else None
            values[row, column] = np.nan if number is None else number
    return values


def _reason(cells: tuple[str, ...], indices: list[int], names: tuple[str, str, str]) -> str:
    """Why a row is refused."""
    for index, name in zip(indices, names, strict=True):
        if index >= len(cells):
            return f"{len(cells)} cells, none for {name}"
        if finite(cells[index]) is None:
            return f"{name} is '{cells[index][:20]}'"
    return "not a row of numbers"


def _cell(line: str, index: int) -> str:
    if index == 0:
        return line.split(",", 1)[0].strip(' "')
    cells = split_row(line, ",")
    return cells[index] if index < len(cells) else ""


def _components_of(header: TextTable) -> tuple[str, str, str]:
    present = {column.lower() for column in header.columns}
    for names in _COMPONENTS:
        if {name.lower() for name in names} <= present:
            return names
    raise FormatError(
        f"no columns Ux, Uy, Uz among {', '.join(header.columns[:20])}",
        where=f"{header.source}:2",
        cure="name the three components with the option columns",
    )
