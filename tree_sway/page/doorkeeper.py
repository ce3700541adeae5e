# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Sockets before they are clients: how many may be open, and how long one may take to ask.

An HTTP server waits for a handshake and a request as long as they take; a thousand sockets that
send a byte now and then would hold it forever. So sockets are counted when they are accepted.
Those that have shown the token have places of their own, and a new one takes the place of the
oldest that has not: whoever fills the server with sockets shuts out nobody who may come in.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
import contextlib
from dataclasses import dataclass
import socket
import ssl

ASKING_TIME = 5.0
"""A socket that has sent no whole request by then is closed, handshake included [s]."""

_PAUSE = 1.0
"""After the system refused a socket [s]."""

MakeProtocol = Callable[[], asyncio.BaseProtocol]


@dataclass(eq=False)
class _Visitor:
    """One socket, from when it is accepted."""

    socket: socket.socket
    timer: asyncio.TimerHandle | None = None
    task: asyncio.Task[None] | None = None
    transport: asyncio.Transport | None = None

    def is_open(self) -> bool:
        return self.transport is None or not self.transport.is_closing()


class Doorkeeper:
    """
    Accepts sockets, and closes those that are too many or too slow.

    Parameters
    ----------
    most
        Sockets that may be open without having shown the token, and as many that have.
    complain
        Called with a sentence when the system gives no further socket.

    """

    def __init__(self, most: int, complain: Callable[[str], None]) -> None:
        self.most, self._complain = most, complain
        self.n_closed = 0
        """Sockets that were closed as too slow or too many."""
        self._visitors: dict[asyncio.BaseProtocol, _Visitor] = {}
        self._strangers: dict[_Visitor, None] = {}
        self._known: set[_Visitor] = set()

    @property
    def n_open(self) -> int:
        """Sockets that are open."""
        return sum(visitor.is_open() for visitor in (*self._strangers, *self._known))

    async def admit(
        self, listener: socket.socket, make: MakeProtocol, tls: ssl.SSLContext | None
    ) -> None:
        """Accept sockets until cancelled, and hand each to a protocol of an HTTP server."""
        loop = asyncio.get_running_loop()
        while True:
            try:
                accepted, _ = await loop.sock_accept(listener)
            except OSError as error:
                self._complain(f'no further connection can be taken: {error.strerror}')
                await asyncio.sleep(_PAUSE)
                continue
            self._make_room()
            visitor = _Visitor(accepted)
            self._strangers[visitor] = None
            visitor.timer = loop.call_later(ASKING_TIME, self._turn_away, visitor)
            visitor.task = loop.create_task(self._hand_over(visitor, make, tls))

    def let_in(self, protocol: asyncio.BaseProtocol, *, is_known: bool) -> None:
        """Note that a whole request has come, and whether it showed the token."""
        visitor = self._visitors.get(protocol)
        if visitor is None:
            return
        if visitor.timer is not None:
            visitor.timer.cancel()
        if is_known and visitor in self._strangers:
            if len(self._known) < self.most:
                del self._strangers[visitor]
                self._known.add(visitor)

    async def _hand_over(
        self, visitor: _Visitor, make: MakeProtocol, tls: ssl.SSLContext | None
    ) -> None:
        def made() -> asyncio.BaseProtocol:
            protocol = make()
            self._visitors[protocol] = visitor
            return protocol

        try:
            transport, _ = await asyncio.get_running_loop().connect_accepted_socket(
                made, visitor.socket, ssl=tls, ssl_handshake_timeout=ASKING_TIME if tls else None
            )
            visitor.transport = transport
        except OSError:  # a handshake that failed or was broken off
            self._turn_away(visitor)

    def _make_room(self) -> None:
        """Forget sockets that are closed, then close the oldest without the token if need be."""
        self._strangers = {each: None for each in self._strangers if each.is_open()}
        self._known = {each for each in self._known if each.is_open()}
        self._visitors = {key: each for key, each in self._visitors.items() if each.is_open()}
        if len(self._strangers) >= self.most:
            self._turn_away(next(iter(self._strangers)))

    def _turn_away(self, visitor: _Visitor) -> None:
        """Close a socket at once."""
        self._strangers.pop(visitor, None)
        self.n_closed += 1
        if visitor.timer is not None:
            visitor.timer.cancel()
        if visitor.transport is not None:
            visitor.transport.abort()
        elif visitor.task is not None:
            visitor.task.cancel()
        with contextlib.suppress(OSError):
            visitor.socket.shutdown(socket.SHUT_RDWR)
