# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Transports whose work is a coroutine, in an event loop of asyncio on the thread of a link."""

from __future__ import annotations

from abc import ABC, abstractmethod
import asyncio
import math

from tree_sway.live.transports.http_failure import failure_without_address
from tree_sway.live.transports.link import Link

_LOOK = 0.05
"""Interval at which the end is looked for [s]."""


class LoopTransport(ABC):
    """A transport that awaits what comes; errors of HTTP do not tell its whole address."""

    silence = math.inf
    """Longest time without a message [s]."""

    def listen(self, receiver: Link) -> None:
        """Deliver messages until the work ends or the receiver is over; raise what it raises."""
        with failure_without_address():
            asyncio.run(self._watch(receiver))

    @abstractmethod
    async def _work(self, receiver: Link) -> None:
        """Connect and deliver messages; a `ConnectionError` has the reason of an end."""

    async def _watch(self, receiver: Link) -> None:
        task = asyncio.ensure_future(self._work(receiver))
        while not task.done():
            await asyncio.wait([task], timeout=_LOOK)
            receiver.rest()
            if receiver.is_over:
                task.cancel()
                await asyncio.wait([task], timeout=1.0)
                return
        task.result()
