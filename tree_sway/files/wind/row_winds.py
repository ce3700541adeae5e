# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Wind of the rows of a table: from components, or from speed and direction."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.arrays import Floats
from tree_sway.files.column_names import unit_factor
from tree_sway.files.table_file import are_nines, Column, TextTable
from tree_sway.files.text_file import finite
from tree_sway.files.wind.compass import degrees_of, FULL_CIRCLE, velocity_to
from tree_sway.files.wind.record import WindRows

_CALM = 1e-9


class RowWinds(NamedTuple):
    """Velocity of each row in [m/s], (n, 3), and which rows are good, (n,)."""

    velocity: Floats
    good: NDArray[np.bool_]


def winds_of_components(table: TextTable, columns: list[Column], rows: WindRows) -> RowWinds:
    """Return the wind of two or three components; rows without numbers are refused."""
    indices = [column.index for column in columns]
    values = table.values(indices) * [column.factor for column in columns]
    good = np.all(np.isfinite(values), axis=1)
    for row in np.flatnonzero(~good).tolist():
        rows.refuse(table.numbers[row], table.why_none(row, indices))
    velocity = np.zeros((len(values), 3))
    velocity[:, : values.shape[1]] = values
    return RowWinds(velocity, good)


def winds_of_directions(
    table: TextTable,
    speed: Column,
    direction: Column | float,
    rows: WindRows,
    yaw: float,
    convention: str,
) -> RowWinds:
    """
    Return the wind of speeds and directions, or of speeds from one direction in degrees.

    A direction may be missing in a calm. Rows are refused without a speed or a direction.
    """
    speeds = table.values([speed.index])[:, 0] * speed.factor
    cells = table.cells(speed.index, range(len(speeds)))
    speeds[are_nines(cells, speeds / speed.factor)] = np.nan
    degrees, texts = _degrees(table, direction)
    degrees = np.where(np.isnan(degrees) & (np.abs(speeds) < _CALM), 0.0, degrees)
    has_speed = speeds >= 0.0
    good = has_speed & (np.abs(degrees) < FULL_CIRCLE)
    for row in np.flatnonzero(~good).tolist():
        if has_speed[row]:
            name = '' if isinstance(direction, float) else table.columns[direction.index]
            why = _why_no_direction(name, texts[row], degrees[row])
        elif speeds[row] < 0.0:
            why = f'speed is {speeds[row]:g}'
        elif finite(cells[row]) is not None:
            why = f"speed is '{cells[row]}', taken as missing"
        else:
            why = table.why_none(row, [speed.index])
        rows.refuse(table.numbers[row], why)
    bearing = np.radians(np.where(good, degrees, 0.0)) - yaw
    against = 1.0 if convention == 'to' else -1.0
    return RowWinds(velocity_to(against * speeds, bearing), good)


def _degrees(table: TextTable, direction: Column | float) -> tuple[Floats, list[str]]:
    n_rows = len(table.texts)
    if isinstance(direction, float):
        return np.full(n_rows, direction), [''] * n_rows
    texts = table.cells(direction.index, range(n_rows))
    to_degrees = direction.factor / (unit_factor('angle', 'deg') or 1.0)
    return degrees_of(texts) * to_degrees, texts


def _why_no_direction(name: str, text: str, degrees: float) -> str:
    if np.isfinite(degrees):
        return f'direction is {degrees:g} degrees'
    return f"{name} is '{text[:40]}', neither degrees nor a point of the compass"
