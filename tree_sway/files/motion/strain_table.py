# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Tables of strain gauges: the time, then pairs of columns, strain on the north and the east side.

So are the days of Wytham (doi:10.5285/533d87d3-48c1-4c6e-9f2f-fda273ab45bc, a pair for each tree
of a logger), of Danum (doi:10.5285/657f420e-f956-4c33-b7d6-98c7a18aa07a, its NE files, pairs at
several heights) and of many sites in one form (doi:10.5281/zenodo.4915883). No column tells where
a pair sits. A header is optional; a unit in its brackets counts.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.errors import FormatError
from tree_sway.files.column_names import unit_known
from tree_sway.files.layouts.known import table_of
from tree_sway.files.layouts.plain import header_line
from tree_sway.files.motion.motion_record import MotionRecord
from tree_sway.files.paths import of_file
from tree_sway.files.table_file import filled_lines, split_row, TextTable
from tree_sway.files.text_file import finite, read_lines
from tree_sway.files.time_stamps import times_of
from tree_sway.twin import as_orientation

_BROKEN = 0.02
"""Strain at which wood has broken long since (Kretschmann 2010, Wood Handbook, chapter 5)."""


@dataclass(frozen=True, eq=False)
class StrainRecord:
    """
    Strain over time: `MotionRecord.time` in [s], (n,), and strain of each pair [-], (n, g, 2).

    A cell that is no number is kept as not a number.
    """

    time: Floats
    strain: Floats
    source: str
    epoch: float | None
    notes: tuple[str, ...]

    def motion(self, pair: int = 0) -> MotionRecord:
        """Return a pair, about its median, as the record of a sensor at a place of strain."""
        strain = self.strain[:, pair]
        turns = as_orientation(strain - np.nanmedian(strain, axis=0))
        return MotionRecord(self.time, None, None, turns, self.source, self.epoch, self.notes)


@of_file
def read_strain(path: Path) -> StrainRecord:
    """
    Read a table of strain gauges.

    Raises
    ------
    FormatError
        No time in its first column, no pairs, an unknown unit, or values that wood does not bear.

    """
    table = _table(read_lines(path), str(path))
    size = len(table.columns)
    units = [table.unit_of(index, 'strain') for index in range(size)]
    of_strain = (n for n in range(1, size) if not units[n] or unit_known('strain', units[n]))
    gauges = [*of_strain] or range(1, size)
    if not gauges or len(gauges) % 2:
        raise table.error(
            f'{len(gauges)} columns beside the time',
            cure='give the time, then two columns for each place: north side, east side',
        )
    dated = table.cells(0, table.rows)
    times = times_of(dated)
    unit = units[gauges[0]]
    factor = table.known_factor('strain', unit) if unit else 1.0
    values = table.values(gauges) * factor
    if not (np.isfinite(times.seconds).any() and np.isfinite(values).any(axis=0).all()):
        raise table.error(
            f"no time in '{''.join(dated[:1])}', or a column without numbers",
            cure='put the time first, and leave that pair out',
        )
    away = np.abs(values - np.nanmedian(values, axis=0))
    if (largest := float(np.nanquantile(away, 0.99))) > _BROKEN:
        raise FormatError(
            f'changes of {largest:.3g} are no strain of wood',
            cure='give strain, or its unit in the header, as north [microstrain]; calibrate '
            'voltages',
        )
    unused = ', '.join(table.columns[each] for each in range(1, size) if each not in gauges)
    notes = (
        f'{path.name}: {len(gauges) // 2} pairs of strain, north and east side',
        times.note,
        f'columns that are not used: {unused}' if unused else '',
    )
    pairs = values.reshape(len(values), -1, 2)
    return StrainRecord(times.seconds, pairs, str(path), times.epoch, tuple(filter(None, notes)))


def _table(lines: list[str], source: str) -> TextTable:
    """Return a table by its header, else its numbers in columns without names."""
    if header_line(lines) is not None:
        return table_of(lines, source)
    numbers, lines = filled_lines(lines)
    first = lines[0] if lines else ''
    separator = next((each for each in '\t;,' if each in first), ' ')
    split = partial(split_row, separator=separator)
    if separator != ',':  # a comma is that of a decimal fraction
        lines = [line.replace(',', '.') for line in lines]
    names = split(first)
    begin = len(names) > 1 and finite(names[1]) is None
    columns = names if begin else [''] * len(names)
    return TextTable(tuple(columns), numbers[begin:], lines[begin:], split, source)
