# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""An event loop of asyncio on the thread of a link."""

from __future__ import annotations

import asyncio
from collections.abc import Coroutine

from tree_sway.live.transports.link import Link

_LOOK = 0.05
"""Interval at which the end is looked for [s]."""


def run_until_over(work: Coroutine[object, object, None], receiver: Link) -> None:
    """Run a coroutine until it ends, or the receiver is over; raise what it raises."""

    async def watch() -> None:
        task = asyncio.ensure_future(work)
        while not task.done():
            await asyncio.wait([task], timeout=_LOOK)
            receiver.rest()
            if receiver.is_over:
                task.cancel()
                await asyncio.wait([task], timeout=1.0)
                return
        task.result()

    asyncio.run(watch())
