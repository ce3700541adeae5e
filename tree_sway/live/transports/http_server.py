# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Requests that a station sends to a port of this machine."""

from __future__ import annotations

import asyncio
from dataclasses import dataclass, field
import hmac
import logging
import socket
from urllib.parse import parse_qs

from aiohttp import web

from tree_sway.doorkeeper import Doorkeeper
from tree_sway.live.transports.link import Link
from tree_sway.live.transports.loop_transport import LoopTransport
from tree_sway.live.transports.transport import Message

_LARGEST = 65_536
"""Largest body of a request [bytes]."""
_TIMEOUT = 5.0
"""Longest time in which a body must have arrived [s]."""
_MOST_SOCKETS = 16
_MOST_FIELDS = 500
_OF_BROWSERS = 'Origin Referer Accept-Language Sec-Fetch-Site Sec-Fetch-Mode'.split()
"""Headers of browsers: any page can make one send a request, as by an image."""
_WORDS = ('PASSKEY', 'PASSWORD')
"""Fields with the passkey of Ecowitt and of Weather Underground."""


@dataclass(frozen=True)
class HttpServer(LoopTransport):
    """
    A port of this machine; each message is the body of a POST, or the query of a GET.

    Every path is answered by ``success``, the word that Weather Underground answers. With a
    passkey only those are heard who send it, as a field or as a part of the path. Browsers are
    not.
    """

    port: int
    host: str
    passkey: str = field(repr=False)

    def __str__(self) -> str:
        """Return its address."""
        return f'http://{self.host}:{self.port}'

    async def _work(self, receiver: Link) -> None:
        doors = Doorkeeper(_MOST_SOCKETS, receiver.refuse)

        async def take(request: web.Request) -> web.Response:
            def refused(status: int, why: str) -> web.Response:
                receiver.refuse(why)
                return web.Response(status=status, text=f'{why}\n')

            if any(name in request.headers for name in _OF_BROWSERS):
                return refused(403, 'a request of a browser')
            try:
                body = await asyncio.wait_for(request.read(), _TIMEOUT)
            except asyncio.TimeoutError:
                return refused(408, 'a request that is too slow')
            except web.HTTPRequestEntityTooLarge:
                return refused(413, f'a request of more than {_LARGEST} bytes')
            data = body or request.query_string.encode()
            if not self._is_known(request, data):
                return refused(403, 'a request without the passkey')
            doors.let_in(request.transport, is_known=True)
            receiver.deliver(Message(data, request.remote or ''))
            return web.Response(text='success')

        def note(record: logging.LogRecord) -> bool:
            receiver.refuse('a request that is not HTTP')
            return False

        logger = logging.Logger('station')
        logger.addFilter(note)
        application = web.Application(client_max_size=_LARGEST)
        application.router.add_route('*', '/{path:.*}', take)
        runner = web.AppRunner(
            application,
            access_log=None,
            keepalive_timeout=_TIMEOUT,
            lingering_time=0.5,
            shutdown_timeout=0.1,
            logger=logger,
        )
        await runner.setup()
        assert runner.server is not None
        family = socket.AF_INET6 if ':' in self.host else socket.AF_INET
        try:
            with socket.create_server((self.host, self.port), family=family) as listener:
                listener.setblocking(False)
                receiver.opened()
                await doors.admit(listener, runner.server, None)
        finally:
            await runner.cleanup()

    def _is_known(self, request: web.Request, data: bytes) -> bool:
        """Whether a request has the passkey."""
        if not self.passkey:
            return True
        try:
            form = parse_qs(data.decode('utf-8', 'replace'), max_num_fields=_MOST_FIELDS)
        except ValueError:
            return False
        fields = (each for word in _WORDS for each in form.get(word, ()))
        given = [*request.path.split('/'), *fields]
        return any(hmac.compare_digest(each.encode(), self.passkey.encode()) for each in given)
