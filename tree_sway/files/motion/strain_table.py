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

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.errors import FormatError
from tree_sway.files.column_names import name_and_unit, unit_factor
from tree_sway.files.motion.motion_record import MotionRecord
from tree_sway.files.paths import of_file
from tree_sway.files.table_file import filled_lines, split_row
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
    epoch: float | None = None
    notes: tuple[str, ...] = ()

    def motion(self, pair: int = 0) -> MotionRecord:
        """Return a pair as the record of a motion sensor at a place of strain."""
        turns = as_orientation(self.strain[:, pair])
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
    _, lines = filled_lines(read_lines(path))
    first = lines[0] if lines else ''
    separator = next((each for each in '\t;,' if each in first), ' ')
    head, *rows = (split_row(line, separator) for line in lines or [''])
    if len(head) > 1 and finite(head[1]) is not None:
        rows.insert(0, head)
    size = max((len(row) for row in rows), default=0)
    if size < 3 or not size % 2:
        raise FormatError(
            f'{max(size - 1, 0)} columns beside the time',
            cure='give the time, then two columns for each place: north side, east side',
        )
    times = times_of([row[0] for row in rows])
    numbers = [[finite(cell) for cell in row[1:]] + [None] * (size - len(row)) for row in rows]
    values = np.array(numbers, dtype=float) * _factor(head)
    if not (np.isfinite(times.seconds).any() and np.isfinite(values).any(axis=0).all()):
        raise FormatError(
            f"no time in '{rows[0][0]}', or a column without numbers",
            cure='put the time first, and leave that pair out',
        )
    away = np.abs(values - np.nanmedian(values, axis=0))
    if (largest := float(np.nanquantile(away, 0.99))) > _BROKEN:
        raise FormatError(
            f'changes of {largest:.3g} are no strain of wood',
            cure='give strain, or its unit in the header, as north [microstrain]; calibrate '
            'voltages',
        )
    notes = f'{path.name}: {size // 2} pairs of strain, north and east side', times.note
    pairs = values.reshape(len(rows), -1, 2)
    return StrainRecord(times.seconds, pairs, str(path), times.epoch, tuple(filter(None, notes)))


def _factor(head: Sequence[str]) -> float:
    """Factor to strain by the unit of the second column of a header."""
    unit = name_and_unit(head[1], 'strain')[1] if len(head) > 1 else ''
    factor = unit_factor('strain', unit) if unit else 1.0
    if factor is None:
        raise FormatError(
            f"unknown unit of strain '{unit[:20]}'",
            cure='give strain as - or microstrain; calibrate voltages first',
        )
    return factor
