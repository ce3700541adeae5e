# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Wind and motion of a real tree as one record, without ROS (`tree_sway.files.motion.tree_record`).

All times are dates of this machine. Each row is on the disk when the next one comes, and the sheet
is there from the start: a record that breaks off can be read.
"""

from __future__ import annotations

import argparse
from pathlib import Path
import time
from typing import TYPE_CHECKING

from tree_sway.commands import RowFile, say
from tree_sway.errors import inside, ParameterError, TransportError
from tree_sway.files.commands import say_warnings
from tree_sway.files.export import write_tree
from tree_sway.files.motion import RecordedSensor, TreeRecord, write_tree_record
from tree_sway.files.trees import open_tree
from tree_sway.live.commands.live_motion_arguments import sensing
from tree_sway.live.commands.record_clock import iso_date, RecordClock, wait
from tree_sway.live.commands.sensor_arguments import listening
from tree_sway.live.commands.wind_recording import WindTable
from tree_sway.twin import place_on

if TYPE_CHECKING:
    from tree_sway.live.motion.motion_reading import MotionReading

_COLUMNS = {
    'acceleration': ('ax [m/s^2]', 'ay [m/s^2]', 'az [m/s^2]'),
    'rate': ('gx [rad/s]', 'gy [rad/s]', 'gz [rad/s]'),
    'orientation': ('qx', 'qy', 'qz', 'qw'),
}
"""Columns of each quantity."""


def record_tree(arguments: argparse.Namespace, seconds: float) -> int:
    """
    Record ``--sensor`` and ``--motion`` into the folder ``--output``, or until Ctrl-C.

    Raises
    ------
    ParameterError
        No wind, no tree, a place that it does not have, or a folder with something in it.
    FormatError
        A disk that is full.
    TransportError
        No wind or no motion came.

    """
    folder = Path(arguments.output)
    if arguments.sensor is None:
        raise ParameterError('motion without wind', cure='give its source: --wind tempest')
    if arguments.tree is None:
        raise ParameterError(
            'motion without the tree that it is of',
            where='--tree',
            cure='give its file or name: --tree oak.yaml',
        )
    if folder.suffix or folder.is_file() or (folder.is_dir() and any(folder.iterdir())):
        raise ParameterError(
            f"'{folder}' is no new folder",
            where='--output',
            cure='name a folder that is not there yet',
        )
    opened = open_tree(arguments.tree, warn=False)
    say_warnings(opened.warnings)
    for at in arguments.at:
        with inside('--at'):
            place_on(opened.tree, at)
    names = [f'motion_{number}.csv' for number, _ in enumerate(arguments.motion, 1)]
    tables = [MotionTable(folder / name) for name in names]
    wind_table = WindTable(folder / 'wind.csv')
    every: list[RowFile] = [wind_table, *tables]
    end = time.monotonic() + seconds
    with sensing(arguments, heard=[each.take for each in tables]) as feed:
        folder.mkdir(parents=True, exist_ok=True)
        write_tree(folder / 'tree.yaml', opened)
        sensors = feed.sensors.values()
        placed = [
            RecordedSensor(name, each.at, each.live.name)
            for name, each in zip(names, sensors, strict=True)
        ]
        sheet = TreeRecord(folder, 'tree.yaml', 'wind.csv', placed, wind_source=arguments.sensor)
        write_tree_record(sheet)
        with listening(arguments, heard=wind_table.take) as wind:
            wind_table.wind = wind
            wait(end, lambda: any(each.failure for each in every))
            wind_problem = wind.problem
        problems = {name: each.live.problem for name, each in feed.sensors.items()}
    for table in every:
        table.close()
    came = [
        (sensor, table.count) for sensor, table in zip(placed, tables, strict=True) if table.count
    ]
    heard = [sensor for sensor, _ in came]
    write_tree_record(sheet._replace(motion=heard, wind_source=wind.name))
    for name, problem in problems.items():
        if problem:
            say(f'{name}: {problem}')
    if not wind_table.count:
        raise TransportError(wind_problem or 'no wind came', where='--sensor')
    if not came:
        raise TransportError('; '.join(problems.values()) or 'no motion came', where='--motion')
    for table in every:
        if table.count:
            table.say_short(seconds)
    rows = ', '.join(f'{count} samples of {each.source} at {each.at}' for each, count in came)
    print(f'{folder}: {wind_table.count} rows of wind of {wind.name}, {rows}')
    return 0


class MotionTable(RowFile):
    """Table of a motion sensor; its first sample decides on the columns."""

    def __init__(self, path: Path) -> None:
        super().__init__(path)
        self._clock = RecordClock()
        self._names: tuple[str, ...] = ()

    def take(self, sample: MotionReading) -> None:
        """Write a sample, once there is its folder; called by the sensor's thread."""
        if not self._path.parent.is_dir():
            return
        if not self._names:
            self._names = tuple(name for name in _COLUMNS if getattr(sample, name) is not None)
        columns = [column for name in self._names for column in _COLUMNS[name]]
        date = iso_date(self._clock.date(sample.time or time.monotonic()), 'microseconds')
        cells = [
            f'{value:.9g}'
            for name in self._names
            for value in (getattr(sample, name) or [float('nan')] * len(_COLUMNS[name]))
        ]
        self.write(['time', *columns], [date, *cells])
