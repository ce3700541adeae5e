# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Sockets before they are clients: their number, and time until a request.

An HTTP server waits for a handshake and a request without limit; a thousand sockets that rarely
send a byte would occupy it forever. So sockets are counted when they are accepted. Those with the
token have separate places, and a new one replaces the oldest without it: an attacker with many
sockets does not exclude authorised clients.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
import contextlib
import ipaddress
import socket
import ssl

ASKING_TIME = 5.0
"""Time for a whole request, handshake included, after which a socket is closed [s]."""

_PAUSE = 1.0
"""Pause after the system refused a socket [s]."""

_OWN_NAMES = ('localhost',)

_MakeProtocol = Callable[[], asyncio.BaseProtocol]


class Doorkeeper:
    """
    Acceptance of sockets; too many or too slow ones are closed.

    Parameters
    ----------
    most
        Largest number of open sockets without the token, and of those with it.
    complain
        Function called with a sentence when the system refuses a socket.

    """

    def __init__(self, most: int, complain: Callable[[str], object]) -> None:
        self.most = most
        self._complain = complain
        self.n_closed = 0
        """Number of sockets that were closed as too slow or too many."""
        self._strangers: dict[socket.socket, asyncio.TimerHandle] = {}
        self._known: set[socket.socket] = set()
        self._tasks: set[asyncio.Task[None]] = set()

    @property
    def n_open(self) -> int:
        """Number of open sockets."""
        return sum(map(_is_open, (*self._strangers, *self._known)))

    async def admit(
        self, listener: socket.socket, make: _MakeProtocol, tls: ssl.SSLContext | None
    ) -> None:
        """Accept sockets until cancelled, and connect each to a protocol of an HTTP server."""
        loop = asyncio.get_running_loop()
        while True:
            try:
                visitor, _ = await loop.sock_accept(listener)
            except OSError as error:
                self._complain(f'no further connection can be taken: {error.strerror}')
                await asyncio.sleep(_PAUSE)
                continue
            self._make_room()
            self._strangers[visitor] = loop.call_later(ASKING_TIME, self._turn_away, visitor)
            task = loop.create_task(self._connect(visitor, make, tls))
            self._tasks.add(task)
            task.add_done_callback(self._tasks.discard)

    def let_in(self, transport: asyncio.BaseTransport | None, *, is_known: bool) -> None:
        """Record that a whole request was received, and whether it had the token."""
        own = None if transport is None else transport.get_extra_info('socket')
        number = -1 if own is None else own.fileno()
        for visitor in [each for each in self._strangers if each.fileno() == number != -1]:
            self._strangers[visitor].cancel()
            if is_known and len(self._known) < self.most:
                del self._strangers[visitor]
                self._known.add(visitor)

    async def _connect(
        self, visitor: socket.socket, make: _MakeProtocol, tls: ssl.SSLContext | None
    ) -> None:
        limit = ASKING_TIME if tls else None
        with contextlib.suppress(OSError):  # a handshake that failed or was cancelled
            await asyncio.get_running_loop().connect_accepted_socket(
                make, visitor, ssl=tls, ssl_handshake_timeout=limit
            )

    def _make_room(self) -> None:
        """Forget closed sockets, then close the oldest without the token if there are too many."""
        for visitor in [each for each in self._strangers if not _is_open(each)]:
            self._strangers.pop(visitor).cancel()
        self._known = set(filter(_is_open, self._known))
        if len(self._strangers) >= self.most:
            self._turn_away(next(iter(self._strangers)))

    def _turn_away(self, visitor: socket.socket) -> None:
        """Close a socket at once, so that waiting tasks end."""
        self._strangers.pop(visitor).cancel()
        self.n_closed += 1
        with contextlib.suppress(OSError):
            visitor.shutdown(socket.SHUT_RDWR)


def _is_open(visitor: socket.socket) -> bool:
    """Whether a socket is open on both sides."""
    return visitor.fileno() != -1


def is_loopback(address: str) -> bool:
    """Whether an address to bind to is reachable only from this machine."""
    if address in _OWN_NAMES:
        return True
    try:
        return ipaddress.ip_address(address.strip('[]')).is_loopback
    except ValueError:
        return False
