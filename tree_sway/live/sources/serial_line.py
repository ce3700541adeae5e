# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Lines of an instrument on a serial port: RS-232, RS-422, RS-485 or USB."""

from __future__ import annotations

import re

from tree_sway.live.question_options import question_of, silence_of
from tree_sway.live.readers.instrument_lines import EXPECTS, lines_of
from tree_sway.live.source import Source
from tree_sway.live.source_address import SourceAddress
from tree_sway.live.transports.serial_port import NMEA_BAUD, SerialPort

_PLACE = re.compile(r'(/[^\s:]+|COM\d+)(?::(\d{3,7}))?')


def open_source(address: SourceAddress) -> Source:
    """Open a port: ``serial:/dev/ttyUSB0:4800``; the baud rate is that of NMEA if left out."""
    place = _PLACE.fullmatch(address.place)
    if place is None:
        raise address.error('no serial port', 'give serial:/dev/ttyUSB0:4800 or serial:COM3:9600')
    read = lines_of(address)
    baud = int(place[2] or NMEA_BAUD)
    port = SerialPort(place[1], baud, question_of(address), silence_of(address))
    expects = f'{EXPECTS}; is {baud} its baud rate? If not, give that: serial:{place[1]}:9600'
    return Source(port, read, place[1].rpartition('/')[2], expects, messages='lines')
