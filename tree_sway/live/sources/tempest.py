# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
WeatherFlow's Tempest: messages that its hub sends to the whole network, UDP port 50222.

``rapid_wind`` has the wind every three seconds: ``"ob": [time, speed in m/s, degrees]``. The mean
over a minute (``obs_st``) is not read beside it (Tempest API, "UDP Broadcast", version 171).
"""

from __future__ import annotations

from collections.abc import Sequence

from tree_sway.live.readers.json_path import parse_json
from tree_sway.live.readers.values import bearing_of, number
from tree_sway.live.reading import Reading, Refusal, WindReading
from tree_sway.live.source_address import SourceAddress
from tree_sway.live.source_kind import Source, SourceKind
from tree_sway.live.transports.transport import Message
from tree_sway.live.transports.udp import Udp

_PORT = 50222
_KIND = 'rapid_wind'


def open_tempest(address: SourceAddress) -> Source:
    """Open the hubs of this network: ``tempest``, or one station by its ``serial`` number."""
    if address.host or address.place:
        raise address.error('its hub sends to the whole network', 'give tempest, without a place')
    serial = address.text_of('serial')
    port = address.whole('port', _PORT, 1, 65_535)

    def read(message: Message) -> Sequence[Reading]:
        document = parse_json(message.data)
        if not isinstance(document, dict) or document.get('type') != _KIND:
            return ()
        if serial and document.get('serial_number') != serial:
            return ()
        values = document.get('ob')
        cells = [number(each) for each in values] if isinstance(values, list) else []
        if len(cells) < 3 or cells[1] is None or cells[1] < 0.0:
            return [Refusal(_KIND, f'ob is {str(values)[:40]}')]
        bearing = bearing_of(cells[2])
        if bearing is None:
            return [Refusal(_KIND, f'direction is {str(cells[2])[:20]}')]
        sender = str(document.get('serial_number', ''))
        return [WindReading(_KIND, cells[1], bearing, interval=0.0, sender=sender)]

    expects = "a Tempest hub's rapid_wind"
    return Source(Udp('', port, is_shared=True, silence=30.0), read, 'Tempest', expects)


SOURCES = (SourceKind(('tempest',), 'tempest', 'a WeatherFlow Tempest', open_tempest),)
