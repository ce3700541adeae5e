# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Texts of a WebSocket, after a request that is sent first."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import aiohttp

from tree_sway.live.transports.http_failure import without_query
from tree_sway.live.transports.link import Link
from tree_sway.live.transports.loop_transport import LoopTransport
from tree_sway.live.transports.transport import Message

_LARGEST = 2**18
"""Largest message [bytes]; a larger one ends the connection."""
_HEARTBEAT = 10.0
"""Interval at which the server is asked for a sign of life [s]."""
_CONNECT_FOR = 5.0


@dataclass(frozen=True)
class WebSocket(LoopTransport):
    """An address of the scheme ``ws`` or ``wss``, and a text to send when it is open."""

    url: str
    hello: str
    headers: Mapping[str, str] = field(repr=False)
    silence: float

    def __str__(self) -> str:
        """Return its address, without the query."""
        return without_query(self.url)

    async def _work(self, receiver: Link) -> None:
        timeout = aiohttp.ClientTimeout(total=None, connect=_CONNECT_FOR)
        async with (
            aiohttp.ClientSession(timeout=timeout, headers=dict(self.headers)) as session,
            session.ws_connect(self.url, heartbeat=_HEARTBEAT, max_msg_size=_LARGEST) as socket,
        ):
            receiver.opened()
            await socket.send_str(self.hello)
            async for message in socket:
                if message.type is aiohttp.WSMsgType.TEXT:
                    receiver.deliver(Message(message.data.encode()))
                elif message.type is aiohttp.WSMsgType.BINARY:
                    receiver.deliver(Message(message.data))
            raise ConnectionError('closed by the other side')
