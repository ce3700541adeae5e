# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Lines or JSON in datagrams."""

from __future__ import annotations

from tree_sway.sensors.question_options import silence_of
from tree_sway.sensors.readers.instrument_lines import EXPECTS, lines_of
from tree_sway.sensors.source_address import SourceAddress
from tree_sway.sensors.source_kind import Source, SourceKind
from tree_sway.sensors.transports.udp import Udp


def open_udp(address: SourceAddress) -> Source:
    """Open a port: ``udp://:port``, on one address of this machine, or a multicast group."""
    read = lines_of(address)
    link = Udp(address.host, address.port(), silence=silence_of(address))
    return Source(link, read, str(link), EXPECTS, messages='lines')


SOURCES = (SourceKind(('udp',), 'udp://:port', 'datagrams to a port of this machine', open_udp),)
