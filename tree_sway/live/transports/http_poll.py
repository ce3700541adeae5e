# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A document that an HTTP server gives at each request."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping
from dataclasses import dataclass, field
import math

import aiohttp

from tree_sway.live.transports.event_loop import run_until_over
from tree_sway.live.transports.http_failure import failure_without_address, without_query
from tree_sway.live.transports.link import Link
from tree_sway.live.transports.transport import Message

_LARGEST = 2**20
"""Largest document [bytes]."""
_TIMEOUT = 10.0
"""Longest time of a request [s]."""


async def body_of(answer: aiohttp.ClientResponse, largest: int) -> bytes:
    """Return the body of an answer; a `ConnectionError` above a number of bytes."""
    data = b''
    async for block in answer.content.iter_any():
        data += block
        if len(data) > largest:
            raise ConnectionError(f'more than {largest} bytes')
    return data


@dataclass(frozen=True)
class HttpPoll:
    """An address that is requested every some seconds [s], with further headers."""

    url: str
    every: float = 60.0
    headers: Mapping[str, str] = field(default_factory=dict, repr=False)
    silence: float = math.inf

    def __str__(self) -> str:
        """Return its address, without a query that may have a key in it."""
        return without_query(self.url)

    def listen(self, receiver: Link) -> None:
        """Deliver each document; a `ConnectionError` for a status that is not 200."""
        with failure_without_address():
            run_until_over(self._poll(receiver), receiver)

    async def _poll(self, receiver: Link) -> None:
        timeout = aiohttp.ClientTimeout(total=_TIMEOUT)
        async with aiohttp.ClientSession(timeout=timeout, headers=dict(self.headers)) as session:
            is_first = True
            while True:
                data = await self._document(session)
                if is_first:
                    receiver.opened()
                    is_first = False
                receiver.deliver(Message(data))
                await asyncio.sleep(self.every)

    async def _document(self, session: aiohttp.ClientSession) -> bytes:
        try:
            async with session.get(self.url, max_redirects=5) as answer:
                if answer.status != 200:
                    raise ConnectionError(f'HTTP {answer.status} {answer.reason or ""}'.strip())
                return await body_of(answer, _LARGEST)
        except asyncio.TimeoutError:
            raise ConnectionError(f'no answer within {_TIMEOUT:g} s') from None
