# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Lines of a TCP server, such as a converter of a serial port or a multiplexer of a boat."""

from __future__ import annotations

from dataclasses import dataclass
import socket

from tree_sway.live.transports.link import Link
from tree_sway.live.transports.stream_lines import (
    deliver_lines,
    NO_QUESTION,
    Question,
    READ_FOR,
)

_CONNECT_FOR = 5.0
"""Longest wait for a connection [s]."""
_BLOCK = 65_536
"""Most bytes that are read at once."""


@dataclass(frozen=True)
class Tcp:
    """Connection to a host and port."""

    host: str
    port: int
    question: Question = NO_QUESTION
    silence: float = 10.0

    def __str__(self) -> str:
        """Return its address."""
        return f'tcp://{self.host}:{self.port}'

    def listen(self, receiver: Link) -> None:
        """Deliver the lines of the server."""
        with socket.create_connection((self.host, self.port), _CONNECT_FOR) as link:

            def read() -> bytes:
                try:
                    data = link.recv(_BLOCK)
                except TimeoutError:
                    return b''
                if not data:
                    raise ConnectionError('closed by the other side')
                return data

            receiver.opened()
            link.settimeout(READ_FOR)
            deliver_lines(receiver, read, link.sendall, self.question)
