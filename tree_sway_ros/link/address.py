# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Address of an instrument: ``tcp://host:port``, ``udp://:port``, ``serial:/dev/x:9600``."""

from __future__ import annotations

from dataclasses import dataclass
import re

from tree_sway.errors import ParameterError

_NETWORK = re.compile(r'(tcp(?=://[^:])|udp)://([^/:\s]*):(\d{1,5})')
_SERIAL = re.compile(r'serial:(/[^\s:]+|COM\d+)(?::(\d{3,7}))?')
_BAUD = 4800  # of NMEA 0183


@dataclass(frozen=True)
class Address:
    """
    One end of a link, ``tcp``, ``udp`` or ``serial``: a host, or a port.

    For udp an empty place is all interfaces; the number is the port, or the baud rate of the
    serial port.
    """

    kind: str
    place: str
    number: int

    def __str__(self) -> str:
        """Return the address as it is written."""
        return f'{self.kind}:{"" if self.kind == "serial" else "//"}{self.place}:{self.number}'


def read_address(text: str) -> Address:
    """Read an address; a `ParameterError` for any other text."""
    network, serial = _NETWORK.fullmatch(text), _SERIAL.fullmatch(text)
    if network is not None and 0 < int(network[3]) < 65_536:
        return Address(network[1], network[2], int(network[3]))
    if serial is not None:
        return Address('serial', serial[1], int(serial[2] or _BAUD))
    raise ParameterError(
        f"'{text}' is no address of an instrument",
        where="parameter 'address'",
        cure='give tcp://host:port, udp://:port or serial:/dev/ttyUSB0:4800',
    )
