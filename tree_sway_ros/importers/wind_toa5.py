"""
Campbell Scientific TOA5: the table of a data logger with a sonic anemometer.

Four header lines: the logger, the column names, their units, how they were processed. The components
of a sonic, ``Ux Uy Uz``, point where the wind blows, in the axes of the instrument (CSAT3 manual, 2.3);
``yaw`` turns them to east and north. A row with NAN or INF is refused. Diagnostic words differ from
instrument to instrument and are not read.

"""

from __future__ import annotations

from pathlib import Path

from tree_sway_ros.errors import FormatError
from tree_sway_ros.importers.table_file import TextTable, split_row
from tree_sway_ros.importers.text_file import finite, read_lines
from tree_sway_ros.importers.time_stamps import seconds_of_stamps
from tree_sway_ros.importers.wind_record import WindRecord, WindRows
from tree_sway_ros.importers.wind_units import SPEED_UNITS, check_convention, turned, unit_factor

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
    check_convention(direction_convention)
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
    needed = max(stamp_column, *indices) + 1
    for number, line in enumerate(lines[4:], start=5):
        if not line.strip():
            continue
        cells = split_row(line, ",")
        if len(cells) < needed:
            rows.refuse(number, f"{len(cells)} cells of {len(header.columns)}")
            continue
        values = [finite(cells[i]) for i in indices]
        u, v, w = (x if x is None else k * x for x, k in zip(values, scale, strict=True))
        if u is None or v is None or w is None:
            bad = values.index(None)
            rows.refuse(number, f"{names[bad]} is '{cells[indices[bad]][:20]}'")
            continue
        stamps.append(cells[stamp_column])
        rows.add(number, 0.0, turned((u, v, w), yaw, direction_convention))
    seconds, epoch = seconds_of_stamps(stamps)
    rows.time = seconds.tolist()
    return rows.record(epoch=epoch)


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
