# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Wind and motion of a real tree as one record, without ROS (`tree_sway.files.motion.tree_record`).

All times are dates of this machine. Each row is on the disk when the next one comes, and the sheet
is there from the start: a record that breaks off can be read.
"""

from __future__ import annotations

import argparse
import csv
from datetime import datetime, timezone
from pathlib import Path
import sys
import threading
import time
from typing import TextIO, TYPE_CHECKING

from tree_sway.commands.live_motion_arguments import sensing
from tree_sway.commands.record_wind import WindTable
from tree_sway.commands.sensor_arguments import listening
from tree_sway.core.observe.sensor_place import place_on
from tree_sway.errors import inside, ParameterError, TransportError
from tree_sway.files.export.tree_export import write_tree
from tree_sway.files.motion.tree_record import RecordedSensor, TreeRecord, write_tree_record
from tree_sway.files.trees.source import open_tree

if TYPE_CHECKING:
    from tree_sway.sensors.motion.live_motion import MotionSample

_LOOK = 0.1
_COLUMNS = {
    'acceleration': ('ax', 'ay', 'az'),
    'rate': ('gx', 'gy', 'gz'),
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
    TransportError
        No wind or no motion came.

    """
    folder = Path(arguments.output)
    if arguments.sensor is None:
        raise ParameterError('motion without wind', cure='give its source: --wind tempest')
    if arguments.tree is None:
        cure = 'give its file or name: --tree oak.yaml'
        raise ParameterError('motion without the tree that it is of', where='--tree', cure=cure)
    if folder.suffix or folder.is_file() or (folder.is_dir() and any(folder.iterdir())):
        what = f"'{folder}' is no new folder"
        raise ParameterError(what, where='--output', cure='name a folder that is not there yet')
    opened = open_tree(arguments.tree)
    for at in arguments.at:
        with inside('--at'):
            place_on(opened.tree, at)
    tables = [MotionTable() for _ in arguments.motion]
    pause, end = threading.Event(), time.monotonic() + seconds
    with sensing(arguments, heard=[each.take for each in tables]) as feed:
        folder.mkdir(parents=True, exist_ok=True)
        write_tree(folder / 'tree.yaml', opened)
        placed = [
            RecordedSensor(f'motion_{number}.csv', each.at, each.live.name)
            for number, each in enumerate(feed.sensors.values(), 1)
        ]
        sheet = TreeRecord(folder, 'tree.yaml', 'wind.csv', placed, wind_source=arguments.sensor)
        write_tree_record(sheet)
        for table, sensor in zip(tables, placed, strict=True):
            table.path = folder / sensor.file
        with (folder / 'wind.csv').open('w', encoding='utf-8', newline='') as file:
            wind_table = WindTable(file)
            with listening(arguments, heard=wind_table.take) as wind:
                wind_table.wind = wind
                try:
                    while time.monotonic() < end:
                        pause.wait(min(_LOOK, max(end - time.monotonic(), 0.0)))
                except KeyboardInterrupt:
                    pass
            wind_table.close()
        problems = [each.live.problem for each in feed.sensors.values()]
    for table in tables:
        table.close()
    came = [
        (sensor, table.count) for sensor, table in zip(placed, tables, strict=True) if table.count
    ]
    heard = [sensor for sensor, _ in came]
    write_tree_record(sheet._replace(motion=heard, wind_source=wind.name))
    for sensor, problem in zip(placed, problems, strict=True):
        if problem:
            print(f'note: {sensor.source} at {sensor.at}: {problem}', file=sys.stderr)
    if not wind_table.count:
        raise TransportError(wind.problem or 'no wind came', where='--sensor')
    if not came:
        raise TransportError('; '.join(problems) or 'no motion came', where='--motion')
    rows = ', '.join(f'{count} samples of {each.source} at {each.at}' for each, count in came)
    print(f'{folder}: {wind_table.count} rows of wind of {wind.name}, {rows}')
    return 0


class MotionTable:
    """Table of a motion sensor; its first sample decides on the columns."""

    def __init__(self) -> None:
        self.path = Path()
        self.count = 0
        self._ahead = time.time() - time.monotonic()
        self._file: TextIO | None = None
        self._names: tuple[str, ...] = ()

    def take(self, sample: MotionSample) -> None:
        """Write a sample; called by the sensor's thread."""
        if not self.path.name:
            return  # the folder is being made
        if self._file is None:
            self._names = tuple(name for name in _COLUMNS if getattr(sample, name) is not None)
            self._file = self.path.open('w', encoding='utf-8', newline='')
            columns = [column for name in self._names for column in _COLUMNS[name]]
            csv.writer(self._file, lineterminator='\n').writerow(['time', *columns])
        stamp = datetime.fromtimestamp(sample.time + self._ahead, timezone.utc)
        date = stamp.isoformat(timespec='microseconds').replace('+00:00', 'Z')
        cells = [
            f'{value:.9g}'
            for name in self._names
            for value in (getattr(sample, name) or [float('nan')] * len(_COLUMNS[name]))
        ]
        csv.writer(self._file, lineterminator='\n').writerow([date, *cells])
        self.count += 1
        self._file.flush()

    def close(self) -> None:
        """Close the file."""
        if self._file is not None:
            self._file.close()
