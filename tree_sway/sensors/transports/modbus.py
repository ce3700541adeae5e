# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Registers of an instrument with Modbus, over TCP or a serial port, by pymodbus."""

from __future__ import annotations

from dataclasses import dataclass
import importlib
import logging
import struct
from typing import Any

from tree_sway.extras import refuse_missing
from tree_sway.sensors.transports.transport import Message, Receiver

PORT = 502
"""Port of Modbus over TCP."""
KINDS = ('holding', 'input')
"""Kinds of registers."""
_TIMEOUT = 1.0
"""Longest wait for an answer [s]."""


@dataclass(frozen=True)
class Modbus:
    """
    Registers that are read every some seconds [s]; each message has their words, big-endian.

    The place is a host, or a serial device if a baud rate is given.

    Raises
    ------
    MissingDependencyError
        pymodbus, or pyserial for a device, is not installed.

    """

    place: str
    first: int
    count: int
    kind: str = KINDS[0]
    device: int = 1
    port: int = PORT
    baud: int | None = None
    every: float = 1.0
    silence: float = 10.0

    def __post_init__(self) -> None:
        """Check that the libraries are there."""
        refuse_missing(['pymodbus', *(['serial'] if self.baud else [])], '...')

    def __str__(self) -> str:
        """Return its address."""
        return f'modbus:{self.place}:{self.baud or self.port}'

    def listen(self, receiver: Receiver) -> None:
        """Read the registers again and again."""
        # Its log is about each attempt; without a handler Python would print it.
        logging.getLogger('pymodbus').addHandler(logging.NullHandler())
        module: Any = importlib.import_module('pymodbus.client')
        if self.baud:
            options = {'baudrate': self.baud, 'timeout': _TIMEOUT, 'retries': 1}
            client = module.ModbusSerialClient(self.place, **options)
        else:
            options = {'port': self.port, 'timeout': _TIMEOUT, 'retries': 1}
            client = module.ModbusTcpClient(self.place, **options)
        try:
            if not client.connect():
                which = 'device and baud rate' if self.baud else 'host and port'
                raise ConnectionError(f'no connection: is it plugged in, and are {which} right?')
            receiver.opened()
            read = getattr(client, f'read_{self.kind}_registers')
            while not receiver.is_over:
                answer = read(self.first, count=self.count, device_id=self.device)
                if answer.isError():
                    raise ConnectionError(f'the instrument refuses: {answer}')
                words = answer.registers
                receiver.deliver(Message(struct.pack(f'>{len(words)}H', *words)))
                receiver.pause(self.every)
        finally:
            client.close()
