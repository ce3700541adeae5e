# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Present wind of Open-Meteo at any place of the world, without an instrument or a key.

It is the output of weather models at 10 m height, over a quarter of an hour; the request asks for
m/s (Open-Meteo, "Weather Forecast API", `current`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
import re
from urllib.parse import urlencode

from tree_sway.files import dates
from tree_sway.live.readers.json_path import JsonPath, parse_json
from tree_sway.live.readers.named_values import WindNames
from tree_sway.live.readers.values import number, speed_factor
from tree_sway.live.reading import Reading, Refusal, WindReading
from tree_sway.live.source import Source
from tree_sway.live.source_address import SourceAddress
from tree_sway.live.transports.http_poll import HttpPoll
from tree_sway.live.transports.transport import Message

_SERVER = 'https://api.open-meteo.com/v1/forecast'
_EVERY = 300.0
_INTERVAL = 900.0
_PLACE = re.compile(r'([-+]?\d+(?:\.\d+)?),\s*([-+]?\d+(?:\.\d+)?)')
_KIND = 'open-meteo'
_NAMES = WindNames(
    JsonPath('wind_speed_10m'), JsonPath('wind_direction_10m'), JsonPath('wind_gusts_10m'), 'm/s'
)


def read_forecast(message: Message) -> Sequence[Reading]:
    """Read the part ``current`` of an answer."""
    document = parse_json(message.data)
    current = JsonPath('current').find(document)
    if not isinstance(current, dict):
        reason = JsonPath('reason').find(document)
        return [Refusal(_KIND, str(reason)[:80])] if isinstance(reason, str) else ()
    unit = JsonPath('current_units.wind_speed_10m').find(document)
    names = _NAMES
    if isinstance(unit, str):
        names = replace(_NAMES, unit=unit if speed_factor(unit) else 'm/s')
    return [_dated(each, current) for each in names.read(current, _KIND)]


def _dated(reading: Reading, current: dict[str, object]) -> Reading:
    """Return a reading with its time, which is in UTC, and its interval."""
    if not isinstance(reading, WindReading):
        return reading
    times = dates([str(current.get('time', ''))[:40]])
    is_dated = bool(times.seconds[0] == 0.0)
    interval = number(current.get('interval')) or _INTERVAL
    return replace(reading, time=times.epoch if is_dated else None, interval=interval)


def open_source(address: SourceAddress) -> Source:
    """Open a place: ``open-meteo:52.52,13.41``; ``server`` is that of another installation."""
    place = _PLACE.fullmatch(address.place)
    latitude, longitude = (float(place[1]), float(place[2])) if place else (91.0, 0.0)
    if abs(latitude) > 90.0 or abs(longitude) > 180.0:
        raise address.error('no latitude and longitude', 'give open-meteo:52.52,13.41')
    query = {
        'latitude': latitude,
        'longitude': longitude,
        'current': 'wind_speed_10m,wind_direction_10m,wind_gusts_10m',
        'wind_speed_unit': 'ms',
    }
    server = address.text_of('server', _SERVER)
    every = address.number('every', _EVERY, 0.2, 86_400.0)
    transport = HttpPoll(f'{server}?{urlencode(query)}', every)
    name = 'open-meteo' if 'name' in address.options else f'{latitude:g},{longitude:g}, open-meteo'
    return Source(transport, read_forecast, name, "Open-Meteo's current wind", _INTERVAL)
