# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Tables of a motion sensor: a time, and three columns of acceleration or angular rate, or both.

``time,ax,ay,az,gx,gy,gz``, the exports of phyphox (``"Acceleration x (m/s^2)"``, ``"Gyroscope x
(rad/s)"``) and others with units behind their names. An orientation has the columns ``qx``,
``qy``, ``qz`` and ``qw``. A cell that is no number is kept as not a number, so that the sensor
refuses and counts its row.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.files.column_names import COLUMNS, MOTIONS
from tree_sway.files.motion.motion_record import MotionRecord
from tree_sway.files.table_file import parse_table, TextTable
from tree_sway.files.text_file import read_lines
from tree_sway.files.time_stamps import times_of

_AXES = 'xyz'
_ORIENTATION = ('qx', 'qy', 'qz', 'qw')


def read_motion_table(path: Path) -> MotionRecord:
    """
    Read a table of a motion sensor.

    Raises
    ------
    FormatError
        No time, no three axes of acceleration or angular rate and no orientation, or an unknown
        unit.

    """
    table = parse_table(read_lines(path), str(path))
    names = [name.replace('gyroscope', 'gyro') for name, _ in table.headings]
    clock = next((names.index(each) for each in COLUMNS['time']['names'] if each in names), None)
    acceleration = _axes(table, names, 'acceleration')
    rate = _axes(table, names, 'rate')
    orientation = None
    if all(each in names for each in _ORIENTATION):
        orientation = table.values([names.index(each) for each in _ORIENTATION])
    if clock is None or (acceleration is None and rate is None and orientation is None):
        what = f'no {"time" if clock is None else "motion"} among {", ".join(table.columns[:20])}'
        cure = 'call the columns time, ax, ay, az, and gx, gy, gz for an angular rate'
        raise table.error(what, cure=cure)
    stamps = table.cells(clock, range(len(table.texts)))
    times = times_of(stamps, table.factor(clock, 'time'))
    if not np.isfinite(times.seconds).any():
        raise table.error('no time in any row', cure='give seconds or dates')
    return MotionRecord(
        np.asarray(times.seconds), acceleration, rate, orientation, str(path), times.epoch
    )


def _axes(table: TextTable, names: list[str], quantity: str) -> Floats | None:
    """Three columns of a quantity in SI, (n, 3); None without all three."""
    found = [
        next((i for i, name in enumerate(names) if _is_axis(name, quantity, axis)), None)
        for axis in _AXES
    ]
    columns = [each for each in found if each is not None]
    if len(columns) < len(_AXES):
        return None
    factors = [table.factor(each, quantity) for each in columns]
    return np.asarray(table.values(columns) * factors)


def _is_axis(name: str, quantity: str, axis: str) -> bool:
    return name.endswith(axis) and MOTIONS[quantity].fullmatch(name) is not None
