# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Davis WeatherLink Live, by its local interface (Davis, "WeatherLink Live Local API").

``/v1/current_conditions`` has speeds in miles per hour; the last one, ``wind_speed_last``, is new
every 2.5 s, and the instrument may be asked every 10 s.
"""

from __future__ import annotations

from collections.abc import Sequence

from tree_sway.live.readers.json_path import parse_json
from tree_sway.live.readers.weatherlink import read_weatherlink
from tree_sway.live.reading import Reading
from tree_sway.live.source import Source
from tree_sway.live.source_address import SourceAddress
from tree_sway.live.transports.http_poll import HttpPoll
from tree_sway.live.transports.transport import Message

_EVERY = 10.0


def read_conditions(message: Message) -> Sequence[Reading]:
    """Read the conditions of the first station with a wind."""
    return read_weatherlink(parse_json(message.data))


def open_source(address: SourceAddress) -> Source:
    """Open an instrument: ``weatherlink:HOST``."""
    if not address.place:
        raise address.error('no host', 'give weatherlink:192.168.1.30')
    url = f'http://{address.place}/v1/current_conditions'
    every = address.number('every', _EVERY, 0.2, 3600.0)
    expects = "the conditions of Davis's local interface"
    return Source(HttpPoll(url, every), read_conditions, 'WeatherLink Live', expects, 0.0)
