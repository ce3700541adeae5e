# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Registers of an instrument with Modbus, over TCP or a serial port.

Two requests are enough: to read holding and input registers (Modbus application protocol 1.1b3,
6.3 and 6.4), in the frames of Modbus TCP or of RTU with its checksum.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
import importlib
from itertools import cycle
import socket
import struct
import time
from typing import Any

from tree_sway.extras import refuse_missing
from tree_sway.live.transports.link import Link
from tree_sway.live.transports.transport import Message

PORT = 502
"""Port of Modbus over TCP."""
KINDS = {'holding': 3, 'input': 4}
"""Kinds of registers, and the function that reads each."""
_TIMEOUT = 1.0
"""Longest wait for an answer [s]."""
_FAILED = 0x80
_FAILURES = {
    1: 'it has no such kind of registers', 2: 'it has no such register', 3: 'illegal value',
    4: 'it failed', 6: 'it is busy', 10: 'no way to it', 11: 'no answer behind the gateway',
}  # fmt: skip

Exchange = Callable[[bytes], bytes]
"""Function that sends a request to the device and returns the body of its answer."""


@dataclass(frozen=True)
class Modbus:
    """
    Registers that are read every some seconds [s]; each message has their words, big-endian.

    The place is a host, or a serial device if a baud rate is given.

    Raises
    ------
    MissingDependencyError
        pyserial, for a device, is not installed.

    """

    place: str
    first: int
    count: int
    kind: str = 'holding'
    device: int = 1
    port: int = PORT
    baud: int | None = None
    every: float = 1.0
    silence: float = 10.0

    def __post_init__(self) -> None:
        """Check that the library for a device is there."""
        refuse_missing(['serial'] if self.baud else [], '...')

    def __str__(self) -> str:
        """Return its address."""
        return f'modbus:{self.place}:{self.baud or self.port}'

    def listen(self, receiver: Link) -> None:
        """Read the registers again and again."""
        function = KINDS[self.kind]
        size = 2 * self.count
        request = struct.pack('>BHH', function, self.first, self.count)
        with self._line() if self.baud else self._network() as exchange:
            receiver.opened()
            while not receiver.is_over:
                answer = exchange(request)
                if answer[0] == function | _FAILED:
                    why = _FAILURES.get(answer[1], f'code {answer[1]}')
                    raise ConnectionError(f'the instrument refuses: {why}')
                if (answer[0], answer[1], len(answer)) != (function, size, 2 + size):
                    raise ConnectionError('its answer is not that of Modbus')
                receiver.deliver(Message(answer[2:]))
                receiver.pause(self.every)

    @contextmanager
    def _network(self) -> Iterator[Exchange]:
        """Modbus TCP: a number of the exchange, zero, the length and the device come first."""
        with socket.create_connection((self.place, self.port), _TIMEOUT) as link:
            numbers = cycle(range(0x1_0000))

            def read(size: int, end: float) -> bytes:
                data = b''
                while len(data) < size:
                    left = end - time.monotonic()
                    if left <= 0.0:
                        raise TimeoutError
                    link.settimeout(left)
                    block = link.recv(size - len(data))
                    if not block:
                        raise ConnectionError('closed by the other side')
                    data += block
                return data

            def exchange(request: bytes) -> bytes:
                number = next(numbers)
                head = struct.pack('>HHHB', number, 0, len(request) + 1, self.device)
                link.sendall(head + request)
                end = time.monotonic() + _TIMEOUT
                while True:
                    theirs, zero, size, device = struct.unpack('>HHHB', read(7, end))
                    if zero or not 3 <= size <= 3 + 2 * self.count:
                        raise ConnectionError('its answer is not that of Modbus')
                    answer = read(size - 1, end)
                    if theirs == number:  # others are late answers
                        self._refuse_other(device)
                        return answer

            yield exchange

    @contextmanager
    def _line(self) -> Iterator[Exchange]:
        """RTU: the device comes first, a checksum last."""
        serial: Any = importlib.import_module('serial')
        with serial.Serial(
            self.place, self.baud, timeout=_TIMEOUT, write_timeout=_TIMEOUT
        ) as port:

            def exchange(request: bytes) -> bytes:
                port.reset_input_buffer()
                frame = bytes([self.device]) + request
                port.write(frame + checksum(frame))
                answer = bytes(port.read(3))
                if len(answer) == 3:
                    is_failure = answer[1] & _FAILED
                    answer += bytes(port.read(2 if is_failure else min(answer[2], 250) + 2))
                if len(answer) < 5:
                    raise ConnectionError(f'no answer of device {self.device}')
                if checksum(answer[:-2]) != answer[-2:]:
                    raise ConnectionError('its answer has a wrong checksum')
                self._refuse_other(answer[0])
                return answer[1:-2]

            yield exchange

    def _refuse_other(self, device: int) -> None:
        """Raise a `ConnectionError` for an answer of another device, such as of a gateway."""
        if device != self.device:
            raise ConnectionError(f'device {device} answers in place of {self.device}')


def checksum(frame: bytes) -> bytes:
    """Return the checksum of RTU: CRC-16 with the polynomial 0xA001, low byte first."""
    value = 0xFFFF
    for each in frame:
        value ^= each
        for _ in range(8):
            value = value >> 1 ^ (0xA001 if value & 1 else 0)
    return value.to_bytes(2, 'little')
