# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A document that an HTTP server gives at each request."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import aiohttp

from tree_sway.live.transports.http_failure import without_query
from tree_sway.live.transports.link import Link
from tree_sway.live.transports.loop_transport import LoopTransport
from tree_sway.live.transports.transport import Message

_LARGEST = 2**20
"""Largest document [bytes]."""
_TIMEOUT = 10.0
"""Longest time of a request [s]."""


async def document_of(
    session: aiohttp.ClientSession, url: str, largest: int, hint: str = '', **options: Any
) -> bytes:
    """
    Return the document at an address.

    A `ConnectionError` for a status that is not 200, which a hint may follow, for more than a
    number of bytes, and for none in the time of the session.
    """
    data = b''
    try:
        async with session.get(url, **options) as answer:
            if answer.status != 200:
                status = f'HTTP {answer.status} {answer.reason or ""}'.strip()
                raise ConnectionError(f'{status}{hint}')
            async for block in answer.content.iter_any():
                data += block
                if len(data) > largest:
                    raise ConnectionError(f'more than {largest} bytes')
    except asyncio.TimeoutError:
        raise ConnectionError(f'no answer within {session.timeout.total:g} s') from None
    return data


@dataclass(frozen=True)
class HttpPoll(LoopTransport):
    """An address that is requested every some seconds [s], with further headers."""

    url: str
    every: float
    headers: Mapping[str, str] = field(default_factory=dict, repr=False)

    def __str__(self) -> str:
        """Return its address, without a query that may have a key in it."""
        return without_query(self.url)

    async def _work(self, receiver: Link) -> None:
        timeout = aiohttp.ClientTimeout(total=_TIMEOUT)
        async with aiohttp.ClientSession(timeout=timeout, headers=dict(self.headers)) as session:
            while True:
                data = await document_of(session, self.url, _LARGEST, max_redirects=5)
                if not receiver.is_up:
                    receiver.opened()
                receiver.deliver(Message(data))
                await asyncio.sleep(self.every)
