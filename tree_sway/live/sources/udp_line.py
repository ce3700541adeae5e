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
    return Udp(address.host, address.port(cure='give udp:5006'), silence=silence_of(address))


def open_source(address: SourceAddress) -> Source:
    """Open a port: ``udp:port``, on one address of this machine, or a multicast group."""
    read = lines_of(address)
    link = udp_of(address)
    return Source(link, read, str(link), EXPECTS, messages='lines')
