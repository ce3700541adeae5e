# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Lines of an instrument behind a TCP server, as a converter of a serial port."""

from __future__ import annotations

from tree_sway.live.question_options import question_of, silence_of
from tree_sway.live.readers.instrument_lines import EXPECTS, lines_of
from tree_sway.live.source import Source
from tree_sway.live.source_address import SourceAddress
from tree_sway.live.transports.tcp import Tcp


def open_source(address: SourceAddress) -> Source:
    """Open a server: ``tcp://host:port``."""
    if not address.host:
        raise address.error('no host', 'give tcp://host:port')
    read = lines_of(address)
    link = Tcp(address.host, address.port(), question_of(address), silence_of(address))
    return Source(link, read, f'{link.host}:{link.port}', EXPECTS, messages='lines')
