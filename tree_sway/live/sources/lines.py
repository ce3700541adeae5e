# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Lines of an instrument: on a serial port, behind a TCP server such as a converter, or in datagrams.

A serial port is RS-232, RS-422, RS-485 or USB. Instruments that answer questions are asked.
"""

from __future__ import annotations

import re

from tree_sway.live.readers.instrument_lines import EXPECTS, lines_of
from tree_sway.live.source import Source
from tree_sway.live.source_address import SourceAddress
from tree_sway.live.transports.serial_port import NMEA_BAUD, SerialPort
from tree_sway.live.transports.stream_lines import Question
from tree_sway.live.transports.tcp import Tcp
from tree_sway.live.transports.udp import Udp

_PLACE = re.compile(r'(/[^\s:]+|COM\d+)(?::(\d{3,7}))?')


def open_source(address: SourceAddress) -> Source:
    """
    Open a serial port, a server or a port: ``serial:/dev/ttyUSB0:4800``, ``tcp://host:port``.

    The baud rate is that of NMEA if left out. ``udp:port`` may be on one address of this machine,
    or a multicast group.
    """
    read = lines_of(address)
    expects = EXPECTS
    link: SerialPort | Tcp | Udp
    if address.scheme == 'serial':
        place = _PLACE.fullmatch(address.place)
        if place is None:
            cure = 'give serial:/dev/ttyUSB0:4800 or serial:COM3:9600'
            raise address.error('no serial port', cure)
        baud = int(place[2] or NMEA_BAUD)
        link = SerialPort(place[1], baud, _question_of(address), address.silence())
        name = place[1].rpartition('/')[2]
        expects += f'; is {baud} its baud rate? If not, give that: serial:{place[1]}:9600'
    elif address.scheme == 'tcp':
        if not address.host:
            raise address.error('no host', 'give tcp://host:port')
        link = Tcp(address.host, address.port(), _question_of(address), address.silence())
        name = f'{link.host}:{link.port}'
    else:
        link = udp_of(address)
        name = str(link)
    return Source(link, read, name, expects, messages='lines')


def udp_of(address: SourceAddress) -> Udp:
    """Return the port of ``udp:5006``, or of ``udp://host:5006`` for one address or a group."""
    return Udp(address.host, address.port(cure='give udp:5006'), silence=address.silence())


def _question_of(address: SourceAddress) -> Question:
    r"""
    Read the options ``ask``, sent every ``every`` [s], by default each second.

    A carriage return and a line feed are added, but to a command of SDI-12, which ends with ``!``.
    """
    text = address.text_of('ask')
    every = address.number('every', 1.0, 0.05, 3600.0)
    end = '' if not text or text.endswith('!') else '\r\n'
    return Question(f'{text}{end}'.encode(), every)
