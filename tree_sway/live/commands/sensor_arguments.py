# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The argument ``--sensor``: a live source of wind, which is told of on standard error."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
import threading
import time
from typing import TYPE_CHECKING

import numpy as np

from tree_sway.commands import say
from tree_sway.errors import ParameterError, TransportError
from tree_sway.files.commands import source_name
from tree_sway.files.wind import WindRecord
from tree_sway.live.commands.record_clock import wait
from tree_sway.live.transports.transport import ignore

if TYPE_CHECKING:
    from tree_sway.files.wind import WindReading
    from tree_sway.live import LiveWind

HELP = (
    'live wind instead: udp:PORT, tcp://host:port, serial:/dev/ttyUSB0:4800, modbus:DEVICE, '
    'mqtt://host/topic, signalk://host, http://host/path.json, tempest, weatherlink:HOST, '
    'cumulus:HOST/realtime.txt, ecowitt:PORT, open-meteo:LAT,LON, metar:ICAO (doc/live_wind.md)'
)
_LOOK = 0.1
_PATIENCE = 90.0
"""Longest wait for the first wind of a source [s]: a garden station sends once in a minute."""
_UNREACHED = 12.0
"""Longest wait for its connection [s]: a little longer than a request may take."""


def add_sensor_argument(parser: argparse.ArgumentParser, *others: str) -> None:
    """Add ``--sensor``, and other names of it."""
    names = ('--sensor', *others)
    parser.add_argument(*names, type=source_name, metavar='SOURCE', help=HELP)


say_sensor = partial(say, kind='sensor')
"""Print a line of news of a source."""


@contextmanager
def listening(
    arguments: argparse.Namespace, heard: Callable[[WindReading], None] = ignore
) -> Iterator[LiveWind]:
    """
    Listen to the source of ``--sensor``, and end at once.

    ``heard`` is called with each reading. A `ParameterError` reports a wrong address, or a record
    beside it.
    """
    from tree_sway.live import LiveWind, open_source

    if getattr(arguments, 'wind', None) is not None:
        raise ParameterError('both --sensor and --wind', cure='give one of the two')
    wind = LiveWind(open_source(arguments.sensor), say_sensor, heard=heard)
    wind.start()
    try:
        yield wind
    finally:
        wind.stop()


def _wait_for_wind(wind: LiveWind) -> None:
    """
    Wait for the first reading.

    A `TransportError` with the reason reports that none came, or sooner that the source was never
    reached.
    """
    pause = threading.Event()
    began = time.monotonic()
    say_sensor(f'waiting for {wind.link.transport}; Ctrl-C ends it')
    while wind.newest is None:
        limit = _PATIENCE if wind.link.connections else _UNREACHED
        if time.monotonic() > began + limit:
            raise TransportError(f'no wind within {limit:g} s: {wind.problem}', where='--sensor')
        pause.wait(_LOOK)


def live_record(arguments: argparse.Namespace, seconds: float) -> WindRecord:
    """
    Record a source for a time [s] from its first wind on; Ctrl-C ends the record sooner.

    A `TransportError` reports that no wind came.
    """
    samples = list[tuple[float, tuple[float, float, float]]]()
    with listening(arguments) as wind:
        _wait_for_wind(wind)
        if not wait(time.monotonic() + seconds, lambda: samples.extend(wind.drain())):
            say_sensor('ended: what came so far is used')
        name, refused = wind.name, wind.refused_text
    if len(samples) < 2:
        raise TransportError(
            f'{len(samples)} samples within {seconds:g} s', where='--sensor', cure='wait longer'
        )
    times, velocity = map(np.array, zip(*samples, strict=True))
    rising = np.concatenate([[True], np.diff(np.maximum.accumulate(times)) > 0.0])
    note = f'{name}, {int(rising.sum())} samples{refused}'
    return WindRecord(times[rising] - times[0], velocity[rising], name, notes=(note,))
