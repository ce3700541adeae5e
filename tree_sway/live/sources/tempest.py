# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""WeatherFlow's Tempest: messages that its hub sends to the whole network, UDP port 50222."""

from __future__ import annotations

from tree_sway.files import object_of
from tree_sway.files.wind import Readings
from tree_sway.live.readers.json_path import parse_json
from tree_sway.live.readers.tempest import read_tempest
from tree_sway.live.source import Source
from tree_sway.live.source_address import SourceAddress
from tree_sway.live.transports.transport import Message
from tree_sway.live.transports.udp import Udp

_PORT = 50222


def open_source(address: SourceAddress) -> Source:
    """Open the hubs of this network: ``tempest``, or one station by its ``serial`` number."""
    if address.host or address.place:
        raise address.error('its hub sends to the whole network', 'give tempest, without a place')
    serial = address.text_of('serial')
    port = address.whole('port', _PORT, 1, 65_535)

    def read(message: Message) -> Readings:
        document = parse_json(message.data)
        is_other = serial and object_of(document).get('serial_number') != serial
        return () if is_other else read_tempest(document)

    expects = "a Tempest hub's rapid_wind"
    return Source(Udp('', port, is_shared=True, silence=30.0), read, 'Tempest', expects)
