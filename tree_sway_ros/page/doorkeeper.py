# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Sockets before they are clients: how many may be open, and how long one may take to ask.

An HTTP server waits for a request as long as it takes; a thousand sockets that send a byte now and
then would hold it forever.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import cast

from aiohttp import web

ASKING_TIME = 5.0
"""A socket that has sent no whole request within so long is closed [s]."""

MakeProtocol = Callable[[], asyncio.BaseProtocol]


class Doorkeeper:
    """
    Counts sockets and closes those that are too many or too slow.

    Parameters
    ----------
    most
        Sockets that may be open at once.

    """

    def __init__(self, most: int) -> None:
        self.most = most
        self.n_closed = 0
        self.n_open: Callable[[], int] = int
        self._waiting: dict[asyncio.BaseProtocol, asyncio.TimerHandle] = {}

    def guarding(self, server: web.Server) -> Callable[[], asyncio.Protocol]:
        """Make protocols that hand their socket on to an HTTP server, if it may come in."""
        self.n_open = lambda: len(server.connections)
        return lambda: _Door(self, server)

    def receive(self, make: MakeProtocol, transport: asyncio.Transport) -> None:
        """Hand a socket on, or close it where too many are open."""
        if self.n_open() >= self.most:
            self.n_closed += 1
            transport.abort()
            return
        protocol = make()
        transport.set_protocol(protocol)
        protocol.connection_made(transport)
        loop = asyncio.get_running_loop()
        self._waiting[protocol] = loop.call_later(ASKING_TIME, self._give_up, protocol, transport)

    def let_in(self, protocol: asyncio.BaseProtocol) -> None:
        """Note that a whole request has come."""
        timer = self._waiting.pop(protocol, None)
        if timer is not None:
            timer.cancel()

    def _give_up(self, protocol: asyncio.BaseProtocol, transport: asyncio.Transport) -> None:
        self._waiting.pop(protocol, None)
        if not transport.is_closing():
            self.n_closed += 1
            transport.abort()


class _Door(asyncio.Protocol):
    """A socket until it is handed on."""

    def __init__(self, keeper: Doorkeeper, make: MakeProtocol) -> None:
        self._keeper, self._make = keeper, make

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        self._keeper.receive(self._make, cast('asyncio.Transport', transport))
