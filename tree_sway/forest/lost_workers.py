# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Workers that die in the middle of their work: reported at the first one, and counted."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from contextlib import contextmanager, suppress
import sys
from typing import Any

_TOPIC = 'all'
"""Topic of a Dask scheduler on which it reports every change of a worker."""

_HAD = 'processing-tasks', 'lost-computed-tasks'
"""What a worker that was ended did, and what it had done and not yet given away."""


@contextmanager
def told_lost_workers(client: Any, names: Collection[str]) -> Iterator[None]:
    """Report workers that end inside the block with one of some pieces of work, or its result."""
    lost = list[str]()

    def hear(event: tuple[float, Any]) -> None:
        message = event[1]
        if not isinstance(message, dict) or message.get('action') != 'remove-worker':
            return
        had = {name for kind in _HAD for name in message.get(kind, ())}
        if not had.isdisjoint(names):
            lost.append(str(message.get('worker')))
            if len(lost) == 1:
                _say('a worker was ended (out of memory?): another one does its cases again')

    client.subscribe_topic(_TOPIC, hear)
    try:
        yield
    finally:
        with suppress(Exception):  # the scheduler may be lost
            client.unsubscribe_topic(_TOPIC)
    if len(lost) > 1:
        _say(f'{len(lost)} workers were ended; what they had was done again by others')


def _say(text: str) -> None:
    if sys.stderr is not None:
        print(text, file=sys.stderr, flush=True)
