# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Registers of an instrument with Modbus, over TCP or a serial port.

Two requests are enough: to read holding and input registers (Modbus application protocol 1.1b3,
6.3 and 6.4), in the frames of Modbus TCP or of RTU with its checksum. pymodbus, whose releases
name the device differently, takes registers of another kind for those that were asked for, and
tells neither which other device has answered nor why a port cannot be opened.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import cycle
import socket
import struct
import time

from tree_sway.extras import refuse_missing
from tree_sway.live.transports.link import Link
from tree_sway.live.transports.transport import Message

PORT = 502
"""Port of Modbus over TCP."""
KINDS = {'holding': 3, 'input': 4}
"""Kinds of registers, and the function that reads each."""
_TIMEOUT = 1.0
"""Longest wait for an answer [s]."""
_NOT_MODBUS = 'its answer is not that of Modbus'
_FAILED = 0x80
_FAILURES = {
    1: 'it has no such kind of registers', 2: 'it has no such register', 3: 'illegal value',
    4: 'it failed', 6: 'it is busy', 10: 'no way to it', 11: 'no answer behind the gateway',
}  # fmt: skip

Exchange = Callable[[bytes], bytes]
"""Function that sends a request and returns the answer: device, function and the rest of each."""


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
    silence = 10.0

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
        request = struct.pack('>BBHH', self.device, function, self.first, self.count)
        with self._line() if self.baud else self._network() as exchange:
            receiver.opened()
            while not receiver.is_over:
                answer = exchange(request)
                if answer[0] != self.device:  # such as of a gateway
                    why = f'device {answer[0]} answers in place of {self.device}'
                    raise ConnectionError(why)
                if answer[1] == function | _FAILED:
                    why = _FAILURES.get(answer[2], f'code {answer[2]}')
                    raise ConnectionError(f'the instrument refuses: {why}')
                if (*answer[1:3], len(answer)) != (function, size, 3 + size):
                    raise ConnectionError(_NOT_MODBUS)
                receiver.deliver(Message(answer[3:]))
                receiver.pause(self.every)

    @contextmanager
    def _network(self) -> Iterator[Exchange]:
        """Modbus TCP: a number of the exchange, zero and the length come first."""
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
                link.sendall(struct.pack('>HHH', number, 0, len(request)) + request)
                end = time.monotonic() + _TIMEOUT
                while True:
                    theirs, zero, size = struct.unpack('>HHH', read(6, end))
                    if zero or not 3 <= size <= 3 + 2 * self.count:
                        raise ConnectionError(_NOT_MODBUS)
                    answer = read(size, end)
                    if theirs == number:  # others are late answers
                        return answer

            yield exchange

    @contextmanager
    def _line(self) -> Iterator[Exchange]:
        """RTU: a checksum comes last."""
        import serial

        with serial.Serial(
            self.place, self.baud, timeout=_TIMEOUT, write_timeout=_TIMEOUT
        ) as port:

            def exchange(request: bytes) -> bytes:
                port.reset_input_buffer()
                port.write(request + checksum(request))
                answer = bytes(port.read(3))
                if len(answer) == 3:
                    is_failure = answer[1] & _FAILED
                    answer += bytes(port.read(2 if is_failure else min(answer[2], 250) + 2))
                if len(answer) < 5:
                    raise ConnectionError(f'no answer of device {self.device}')
                if checksum(answer[:-2]) != answer[-2:]:
                    raise ConnectionError('its answer has a wrong checksum')
                return answer[:-2]

            yield exchange


def checksum(frame: bytes) -> bytes:
    """Return the checksum of RTU: CRC-16 with the polynomial 0xA001, low byte first."""
    value = 0xFFFF
    for each in frame:
        value ^= each
        for _ in range(8):
            value = value >> 1 ^ (0xA001 if value & 1 else 0)
    return value.to_bytes(2, 'little')
