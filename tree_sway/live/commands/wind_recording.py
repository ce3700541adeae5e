# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Wind of a live source as a table, without ROS; `tree_sway.files.wind.table` reads it again.

The wind of instants is written as components, means as speed, direction and gust: a reader then
blows gusts about them. Each row is on the disk when the next one comes.
"""

from __future__ import annotations

import argparse
import math
from pathlib import Path
import time

from tree_sway.commands import RowFile
from tree_sway.errors import ParameterError, TransportError
from tree_sway.files.commands import output_path
from tree_sway.files.wind import WindReading
from tree_sway.live import LiveWind
from tree_sway.live.commands.record_clock import iso_date, RecordClock, wait
from tree_sway.live.commands.sensor_arguments import listening
from tree_sway.simulation.wind import LEAST_INTERVAL

_INSTANTS = ('time', 'u [m/s]', 'v [m/s]', 'w [m/s]')
_MEANS = ('time', 'wind_speed [m/s]', 'wind_direction [deg]', 'wind_gust [m/s]')
"""Columns of a table of means."""


def record_wind(arguments: argparse.Namespace, seconds: float) -> int:
    """
    Record ``--sensor`` to the file ``--output`` for a time [s], or until Ctrl-C.

    Raises
    ------
    ParameterError
        Another suffix than ``.csv``, a file that exists, or a wrong address.
    FormatError
        A file that cannot be written, or a disk that is full.
    TransportError
        No wind came.

    """
    path = Path(arguments.output)
    if path.suffix.lower() != '.csv':
        raise ParameterError(f"'{path}' is no table", where='--output', cure='name it wind.csv')
    output_path(arguments)
    end = time.monotonic() + seconds
    table = WindTable(path)
    with listening(arguments, heard=table.take) as wind:
        table.wind = wind
        wait(end, lambda: bool(table.failure))
        problem = wind.problem
    table.close()
    if not table.count:
        raise TransportError(problem or 'no wind came', where='--sensor')
    table.say_short(seconds)
    kind = 'means' if table.is_of_means else 'samples'
    print(f'{path}: {table.count} {kind} of {wind.name}{wind.refused_text}')
    return 0


class WindTable(RowFile):
    """Table of readings; the second one decides whether they are means."""

    wind: LiveWind
    """Their source, from its start on."""

    def __init__(self, path: Path) -> None:
        super().__init__(path)
        self.is_of_means = False
        self._waiting = list[tuple[float, WindReading]]()
        self._before: float | None = None
        self._clock = RecordClock()

    def take(self, reading: WindReading) -> None:
        """Write a reading; called by the source's thread."""
        if reading.time is not None and reading.time == self._before:
            return  # a report that is requested again
        self._before = reading.time
        self._waiting.append((reading.time or self._clock.date(time.monotonic()), reading))
        if self.count or len(self._waiting) > 1:
            self._write_waiting()
        else:
            self.hold()

    def close(self) -> None:
        """Write a single reading; a `FormatError` if a row could not be written."""
        self._write_waiting()
        super().close()

    def _write_waiting(self) -> None:
        for stamp, reading in self._waiting:
            if not self.count:
                self.is_of_means = self.wind.interval >= LEAST_INTERVAL
            if self.is_of_means:
                used = self.wind.bearing if reading.bearing is None else reading.bearing
                gust = '' if reading.gust is None else f'{reading.gust:.3f}'
                degrees = f'{math.degrees(used) % 360.0:.1f}'
                cells = [f'{reading.speed:.3f}', degrees, gust]
            else:
                cells = [f'{value:.3f}' for value in reading.velocity(self.wind.bearing)]
            header = _MEANS if self.is_of_means else _INSTANTS
            self.write(header, [iso_date(stamp, 'milliseconds'), *cells])
        self._waiting.clear()
