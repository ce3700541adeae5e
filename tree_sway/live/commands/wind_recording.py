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
from tree_sway.live import LiveWind
from tree_sway.live.commands.record_clock import iso_date, RecordClock, wait
from tree_sway.live.commands.sensor_arguments import listening
from tree_sway.live.reading import WindReading
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
        wait(end, lambda: bool(table.rows.failure))
        problem = wind.problem
    table.close()
    if not table.count:
        raise TransportError(problem or 'no wind came', where='--sensor')
    table.rows.say_short(seconds)
    kind = 'means' if table.is_of_means else 'samples'
    print(f'{path}: {table.count} {kind} of {wind.name}{wind.refused_text}')
    return 0


class WindTable:
    """Table of readings; the second one decides whether they are means."""

    def __init__(self, path: Path) -> None:
        self.rows = RowFile(path)
        self.is_of_means = False
        self.wind: LiveWind | None = None
        self._first: tuple[float, WindReading] | None = None
        self._before: WindReading | None = None
        self._clock = RecordClock()

    @property
    def count(self) -> int:
        """Number of rows on the disk."""
        return self.rows.count

    def take(self, reading: WindReading) -> None:
        """Write a reading; called by the source's thread."""
        before = self._before
        self._before = reading
        if reading.time is not None and before is not None and reading.time == before.time:
            return  # a report that is requested again
        row = reading.time or self._clock.date(time.monotonic()), reading
        if self._first is None and not self.count:
            self._first = row
            self.rows.hold()
            return
        if self._first is not None:
            self._begin(self._first)
        self._write(row)

    def close(self) -> None:
        """Write a single reading; a `FormatError` if a row could not be written."""
        if self._first is not None:
            self._begin(self._first)
        self.rows.close()

    def _begin(self, first: tuple[float, WindReading]) -> None:
        self._first = None
        assert self.wind is not None
        self.is_of_means = self.wind.interval >= LEAST_INTERVAL
        self._write(first)

    def _write(self, row: tuple[float, WindReading]) -> None:
        stamp, reading = row
        assert self.wind is not None
        if self.is_of_means:
            used = self.wind.bearing if reading.bearing is None else reading.bearing
            gust = '' if reading.gust is None else f'{reading.gust:.3f}'
            degrees = f'{math.degrees(used) % 360.0:.1f}'
            cells = [f'{reading.speed:.3f}', degrees, gust]
        else:
            cells = [f'{value:.3f}' for value in reading.velocity(self.wind.bearing)]
        header = _MEANS if self.is_of_means else _INSTANTS
        self.rows.write(header, [iso_date(stamp, 'milliseconds'), *cells])
