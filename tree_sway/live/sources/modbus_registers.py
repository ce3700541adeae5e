# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Instruments with Modbus, such as most low-cost ultrasonic anemometers on RS-485.

Makers differ in registers and scales: ``speed`` and ``direction`` are the addresses of the two,
as in the manual; ``scale`` and ``direction_scale`` are m/s and degrees in one count. A register
has a signed word of 16 bits.
"""

from __future__ import annotations

import re
import struct

from tree_sway.files.wind import reading_of, Readings, Refusal
from tree_sway.live.source import Source
from tree_sway.live.source_address import SourceAddress
from tree_sway.live.transports.modbus import KINDS, Modbus, PORT
from tree_sway.live.transports.transport import Message

_PLACE = re.compile(r'(/[^\s:]+|COM\d+|[^/\s:]+)(?::(\d{1,7}))?')
_KIND = 'Modbus'
_LARGEST = 65_535
_MOST = 60
_BAUD = 9600
_NO_VALUE = (0x7FFF, -0x8000, -1)
"""Words of a register without a value: the largest and least, and all bits."""


def open_source(address: SourceAddress) -> Source:
    """
    Open an instrument: ``modbus:HOST:502?...`` or ``modbus:/dev/ttyUSB0:9600?...``.

    ``device`` is its number on the line, ``kind`` holding or input registers.
    """
    place = _PLACE.fullmatch(address.place)
    if place is None:
        raise address.error('no host or device', 'give modbus:HOST or modbus:/dev/ttyUSB0:9600')
    speed = address.whole('speed', 0, 0, _LARGEST)
    has_vane = bool(address.text_of('direction'))
    direction = address.whole('direction', speed, 0, _LARGEST)
    scale = address.number('scale', 0.1, 1e-6, 1e3)
    turn = address.number('direction_scale', 1.0, 1e-6, 1e3)
    heading = address.angle('heading_degrees')
    kind = address.text_of('kind', 'holding')
    first = min(speed, direction)
    count = abs(speed - direction) + 1
    if kind not in KINDS or count > _MOST:
        raise address.error(
            f'kind is {kind}, {count} registers', f'use {" or ".join(KINDS)}, up to {_MOST} apart'
        )

    def read(message: Message) -> Readings:
        if len(message.data) != 2 * count:
            return [Refusal(_KIND, f'{len(message.data) // 2} registers of {count}')]
        words = struct.unpack(f'>{count}h', message.data)
        if words[speed - first] in _NO_VALUE:
            return [Refusal(_KIND, f'no speed: the register is {words[speed - first]}')]
        degrees: float | str | None = None
        if has_vane:
            word = words[direction - first]
            degrees = 'none' if word in _NO_VALUE else turn * word
        return [reading_of(_KIND, scale * words[speed - first], degrees, turn=heading)]

    is_serial = place[1].startswith(('/', 'COM'))
    number = int(place[2] or (_BAUD if is_serial else PORT))
    transport = Modbus(
        place[1],
        first,
        count,
        kind,
        address.whole('device', 1, 0, 247),
        port=PORT if is_serial else number,
        baud=number if is_serial else None,
        every=address.number('every', 1.0, 0.02, 3600.0),
    )
    return Source(transport, read, f'Modbus {place[1]}', 'registers of speed and direction')
