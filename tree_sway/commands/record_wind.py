# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Wind of a live source as a table, without ROS; `tree_sway.files.wind.table` reads it again.

The wind of instants is written as components, means as speed, direction and gust: a reader then
blows gusts about them. Each row is on the disk when the next one comes.
"""

from __future__ import annotations

import argparse
import csv
from datetime import datetime, timezone
import math
from pathlib import Path
import threading
import time
from typing import TextIO

from tree_sway.commands.arguments import refuse_overwriting
from tree_sway.commands.sensor_arguments import listening
from tree_sway.core.wind.simulated.about_means import LEAST_INTERVAL
from tree_sway.errors import ParameterError, TransportError
from tree_sway.sensors.live_wind import LiveWind
from tree_sway.sensors.reading import WindReading

_LOOK = 0.1
INSTANTS = ('time', 'u [m/s]', 'v [m/s]', 'w [m/s]')
MEANS = ('time', 'wind_speed [m/s]', 'wind_direction [deg]', 'wind_gust [m/s]')
"""Columns of a table of means."""


def record_wind(arguments: argparse.Namespace, seconds: float) -> int:
    """
    Record ``--sensor`` to the file ``--output`` for a time [s], or until Ctrl-C.

    Raises
    ------
    ParameterError
        Another suffix than ``.csv``, a file that exists, or a wrong address.
    TransportError
        No wind came.

    """
    path = Path(arguments.output)
    if path.suffix.lower() != '.csv':
        raise ParameterError(f"'{path}' is no table", where='--output', cure='name it wind.csv')
    if not arguments.force:
        refuse_overwriting(path, '--output')
    pause, end = threading.Event(), time.monotonic() + seconds
    with path.open('w', encoding='utf-8', newline='') as file:
        table = WindTable(file)
        with listening(arguments, heard=table.take) as wind:
            table.wind = wind
            try:
                while time.monotonic() < end:
                    pause.wait(min(_LOOK, max(end - time.monotonic(), 0.0)))
            except KeyboardInterrupt:
                pass
        table.close()
    if not table.count:
        path.unlink()
        raise TransportError(wind.problem or 'no wind came', where='--sensor')
    print(f'{path}: {table.count} {"means" if table.is_of_means else "samples"} of {wind.name}')
    return 0


class WindTable:
    """Table of readings; the second one decides whether they are means."""

    def __init__(self, file: TextIO) -> None:
        self.count = 0
        self.is_of_means = False
        self.wind: LiveWind | None = None
        self._file, self._writer = file, csv.writer(file, lineterminator='\n')
        self._first: tuple[float, WindReading] | None = None
        self._before: WindReading | None = None

    def take(self, reading: WindReading) -> None:
        """Write a reading; called by the source's thread."""
        before, self._before = self._before, reading
        if reading.time is not None and before is not None and reading.time == before.time:
            return  # a report that is requested again
        row = reading.time or time.time(), reading
        if self._first is None and not self.count:
            self._first = row
            return
        if self._first is not None:
            self._begin(self._first)
        self._write(row)

    def close(self) -> None:
        """Write a single reading."""
        if self._first is not None:
            self._begin(self._first)

    def _begin(self, first: tuple[float, WindReading]) -> None:
        self._first = None
        assert self.wind is not None
        self.is_of_means = self.wind.interval >= LEAST_INTERVAL
        self._writer.writerow(MEANS if self.is_of_means else INSTANTS)
        self._write(first)

    def _write(self, row: tuple[float, WindReading]) -> None:
        stamp, reading = row
        assert self.wind is not None
        date = datetime.fromtimestamp(stamp, timezone.utc).isoformat(timespec='milliseconds')
        if self.is_of_means:
            used = self.wind.bearing if reading.bearing is None else reading.bearing
            gust = '' if reading.gust is None else f'{reading.gust:.3f}'
            degrees = f'{math.degrees(used) % 360.0:.1f}'
            cells = [f'{reading.speed:.3f}', degrees, gust]
        else:
            cells = [f'{value:.3f}' for value in reading.velocity(self.wind.bearing)]
        self._writer.writerow([date.replace('+00:00', 'Z'), *cells])
        self._file.flush()
        self.count += 1
