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

from tree_sway.files import dates, object_of, unit_factor
from tree_sway.files.wind import number
from tree_sway.live.readers.json_path import JsonPath, parse_json
from tree_sway.live.readers.named_values import WindNames
from tree_sway.live.reading import Reading, Refusal, WindReading
from tree_sway.live.transports.transport import Message

_KIND = 'open-meteo'
_NAMES = WindNames(
    JsonPath('wind_speed_10m'), JsonPath('wind_direction_10m'), JsonPath('wind_gusts_10m'), 'm/s'
)


def read_forecast(message: Message) -> Sequence[Reading]:
    """Read the part ``current`` of an answer."""
    document = object_of(parse_json(message.data))
    current = object_of(document.get('current'))
    if isinstance(reason := document.get('reason'), str) and not current:
        return [Refusal(_KIND, reason[:80])]
    unit = JsonPath('current_units.wind_speed_10m').find(document)
    is_known = isinstance(unit, str) and unit_factor('speed', unit) is not None
    names = replace(_NAMES, unit=unit) if is_known else _NAMES
    return [_dated(each, current) for each in names.read(current, _KIND)]


def _dated(reading: Reading, current: dict[str, object]) -> Reading:
    """Return a reading with its time, which is in UTC, and its interval."""
    if not isinstance(reading, WindReading):
        return reading
    times = dates([str(current.get('time', ''))[:40]])
    is_dated = bool(times.seconds[0] == 0.0)
    interval = number(current.get('interval'))
    return replace(reading, time=times.epoch if is_dated else None, interval=interval)
