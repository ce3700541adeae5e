# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Forms that instruments send to an HTTP server on this machine."""

from __future__ import annotations

import asyncio
from dataclasses import dataclass
import math

from aiohttp import web

from tree_sway.sensors.transports.event_loop import run_until_over
from tree_sway.sensors.transports.transport import Message, Receiver

_LARGEST = 65_536
"""Largest body of a request [bytes]."""
_TIMEOUT = 5.0
"""Longest time in which a body must have arrived [s]."""


@dataclass(frozen=True)
class HttpServer:
    """
    A port of this machine; each message is the body of a POST, or the query of a GET.

    Every path is answered by ``success``, the word that Weather Underground answers.
    """

    port: int
    host: str = '0.0.0.0'
    silence: float = math.inf

    def __str__(self) -> str:
        """Return its address."""
        return f'http://{self.host}:{self.port}'

    def listen(self, receiver: Receiver) -> None:
        """Deliver what is sent."""
        run_until_over(self._serve(receiver), receiver)

    async def _serve(self, receiver: Receiver) -> None:
        async def take(request: web.Request) -> web.Response:
            try:
                body = await asyncio.wait_for(request.read(), _TIMEOUT)
            except asyncio.TimeoutError:
                return web.Response(status=408, text='too slow')
            receiver.deliver(Message(body or request.query_string.encode(), request.path))
            return web.Response(text='success')

        application = web.Application(client_max_size=_LARGEST)
        application.router.add_route('*', '/{path:.*}', take)
        runner = web.AppRunner(
            application, access_log=None, keepalive_timeout=_TIMEOUT, shutdown_timeout=0.1
        )
        await runner.setup()
        try:
            await web.TCPSite(runner, self.host, self.port).start()
            receiver.opened()
            await asyncio.Event().wait()
        finally:
            await runner.cleanup()
