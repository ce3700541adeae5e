# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Wind of the rows of a table: from components, or from speed and direction."""

from __future__ import annotations

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.files.column_names import unit_factor
from tree_sway.files.table_file import are_nines, Column, TextTable
from tree_sway.files.text_file import finite
from tree_sway.files.wind.compass import degrees_of, velocity_from
from tree_sway.files.wind.record import WindRows


def winds_of_components(table: TextTable, columns: list[Column], rows: WindRows) -> Floats:
    """Return the wind of two or three components, (n, 3); rows without numbers are refused."""
    indices = [column.index for column in columns]
    values = table.values(indices) * [column.factor for column in columns]
    for row in np.flatnonzero(np.isnan(values).any(axis=1)).tolist():
        rows.refuse(table.numbers[row], table.why_none(row, indices))
    return np.pad(values, ((0, 0), (0, 3 - len(columns))))


def winds_of_directions(
    table: TextTable,
    speed: Column,
    direction: Column | float,
    rows: WindRows,
    yaw: float,
    convention: str,
) -> Floats:
    """
    Return the wind of speeds and directions, or of speeds from one direction in degrees, (n, 3).

    A direction may be missing in a calm. Rows are refused without a speed or a direction.
    """
    speeds = table.values([speed.index])[:, 0] * speed.factor
    cells = table.cells(speed.index, table.rows)
    speeds[are_nines(cells, speeds / speed.factor)] = np.nan
    if isinstance(direction, Column):
        texts = table.cells(direction.index, table.rows)
        degrees = degrees_of(texts) * direction.factor / (unit_factor('angle', 'deg') or 1.0)
    else:
        degrees = np.full(len(speeds), direction)
    velocity = velocity_from(speeds, degrees, yaw)
    for row in np.flatnonzero(np.isnan(velocity[:, 0])).tolist():
        if speeds[row] >= 0.0:
            why = f'direction is {degrees[row]:g} degrees'
            if isinstance(direction, Column) and np.isnan(degrees[row]):
                why = f"{table.columns[direction.index]} is '{texts[row][:40]}', "
                why += 'neither degrees nor a point of the compass'
        elif speeds[row] < 0.0:
            why = f'speed is {speeds[row]:g}'
        elif finite(cells[row]) is not None:
            why = f"speed is '{cells[row]}', taken as missing"
        else:
            why = table.why_none(row, [speed.index])
        rows.refuse(table.numbers[row], why)
    return -velocity if convention == 'to' else velocity
