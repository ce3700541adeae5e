# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Lines or JSON in datagrams."""

from __future__ import annotations

from tree_sway.live.question_options import silence_of
from tree_sway.live.readers.instrument_lines import EXPECTS, lines_of
from tree_sway.live.source import Source
from tree_sway.live.source_address import SourceAddress
from tree_sway.live.transports.udp import Udp


def udp_of(address: SourceAddress) -> Udp:
    """Return the port of ``udp:5006``, or of ``udp://host:5006`` for one address or a group."""
    place = address.place
    if address.parts.netloc:
        port = address.port()
    elif place.isdecimal() and 0 < int(place) < 65_536:
        port = int(place)
    else:
        raise address.error('a port from 1 to 65535 is missing', 'give udp:5006')
    return Udp(address.host, port, silence=silence_of(address))


def open_source(address: SourceAddress) -> Source:
    """Open a port: ``udp:port``, on one address of this machine, or a multicast group."""
    read = lines_of(address)
    link = udp_of(address)
    return Source(link, read, str(link), EXPECTS, messages='lines')
