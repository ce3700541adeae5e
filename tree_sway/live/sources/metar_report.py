# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Reports of an airport from the Aviation Weather Center of the USA, which has those of the world.

Its JSON has the raw report, from which the wind is read as from a file of METAR: a mean over ten
minutes, and the gust (Aviation Weather Center, "Data API", `metar`).
"""

from __future__ import annotations

from collections.abc import Sequence
from math import radians
import re
from urllib.parse import urlencode

from tree_sway.files.wind import METAR
from tree_sway.live.readers.json_path import parse_json
from tree_sway.live.readers.values import number
from tree_sway.live.reading import Reading, Refusal, WindReading
from tree_sway.live.source import Source
from tree_sway.live.source_address import SourceAddress
from tree_sway.live.transports.http_poll import HttpPoll
from tree_sway.live.transports.transport import Message

_SERVER = 'https://aviationweather.gov/api/data/metar'
_EVERY = 300.0
_INTERVAL = 600.0
_LASTS = 9000.0
"""Time for which a report is used [s]: airports report every hour at least."""
_ICAO = re.compile(r'[A-Z][A-Z0-9]{3}')
_KIND = 'METAR'
_UNITS = {'KT': 1852.0 / 3600.0, 'MPS': 1.0, 'KMH': 1.0 / 3.6}


def read_reports(message: Message) -> Sequence[Reading]:
    """Read the newest report of an answer, or of lines of raw reports."""
    document = parse_json(message.data)
    if isinstance(document, list):
        first = document[0] if document else None
        if not isinstance(first, dict) or not isinstance(first.get('rawOb'), str):
            return [Refusal(_KIND, 'no report of this airport')] if not document else ()
        return _read(first['rawOb'], number(first.get('obsTime')), str(first.get('name', '')))
    return _read(message.data.decode('utf-8', 'replace'), None, '')


def _read(text: str, time: float | None, place: str) -> Sequence[Reading]:
    report = METAR.search(text)
    if report is None:
        return ()
    direction, speed, gust, unit = report.group(4, 5, 6, 7)
    if not speed.isdigit() or direction == '///':
        return [Refusal(_KIND, f"no direction or speed in '{direction}{speed}'")]
    bearing = radians(float(direction)) if direction.isdigit() else None
    factor = _UNITS[unit]
    most = factor * float(gust) if gust else None
    return [
        WindReading(
            _KIND,
            factor * float(speed),
            bearing,
            gust=most,
            interval=_INTERVAL,
            time=time,
            place=place.partition(',')[0][:60],
        )
    ]


def open_source(address: SourceAddress) -> Source:
    """Open an airport by its code of ICAO: ``metar:EDDB``."""
    code = address.place.upper()
    if not _ICAO.fullmatch(code):
        raise address.error('no code of an airport', 'give its four letters of ICAO: metar:EDDB')
    server = address.text_of('server', _SERVER)
    every = address.number('every', _EVERY, 0.2, 86_400.0)
    transport = HttpPoll(f'{server}?{urlencode({"ids": code, "format": "json"})}', every)
    return Source(transport, read_reports, f'METAR {code}', 'a METAR report', _INTERVAL, _LASTS)
