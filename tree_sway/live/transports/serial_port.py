# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Lines of a serial port, by pyserial."""

from __future__ import annotations

from dataclasses import dataclass

from tree_sway.extras import refuse_missing
from tree_sway.live.transports.link import Link
from tree_sway.live.transports.stream_lines import (
    deliver_lines,
    NO_QUESTION,
    Question,
    READ_FOR,
)

NMEA_BAUD = 4800
"""Baud rate of NMEA 0183."""


@dataclass(frozen=True)
class SerialPort:
    """
    A device and its baud rate.

    Raises
    ------
    MissingDependencyError
        pyserial is not installed.

    """

    device: str
    baud: int = NMEA_BAUD
    question: Question = NO_QUESTION
    silence: float = 10.0

    def __post_init__(self) -> None:
        """Check that pyserial is there."""
        refuse_missing(['serial'], '...')

    def __str__(self) -> str:
        """Return its address."""
        return f'serial:{self.device}:{self.baud}'

    def listen(self, receiver: Link) -> None:
        """Deliver the lines of the port."""
        import serial

        with serial.Serial(self.device, self.baud, timeout=READ_FOR) as port:
            receiver.opened()
            deliver_lines(
                receiver,
                lambda: bytes(port.read(max(1, port.in_waiting))),
                port.write,
                self.question,
            )
