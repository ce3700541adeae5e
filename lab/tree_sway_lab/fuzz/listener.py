# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A process that listens to one address and tells its counts, once for each line of its input.

``python -m tree_sway_lab.fuzz.listener wind udp://127.0.0.1:5005``; also ``motion`` and
``stream``.
"""

from __future__ import annotations

import json
import sys

from tree_sway.live import LiveMotion, LiveWind, open_motion, open_source
from tree_sway.stream import StreamClient

_PAUSE = 0.02
"""Longest pause between two attempts to connect [s]: a campaign has many."""


def _say(text: str) -> None:
    print(text, file=sys.stderr, flush=True)


def main() -> None:
    """Listen until the input ends."""
    kind, address = sys.argv[1:]
    if kind == 'stream':
        with StreamClient(address) as client:
            for _ in sys.stdin:
                _tell(client.received, client.unreadable)
        return
    live: LiveWind | LiveMotion
    live = LiveMotion(open_motion(address), _say) if kind == 'motion' else LiveWind(
        open_source(address), _say
    )  # fmt: skip
    live.link.first_pause = live.link.longest_pause = _PAUSE
    live.start()
    for _ in sys.stdin:
        live.drain()
        _tell(live.accepted, sum(live.refused.values()) + live.link.connections)
    live.stop()


def _tell(accepted: int, refused: int) -> None:
    print(json.dumps({'accepted': accepted, 'refused': refused}), flush=True)


if __name__ == '__main__':
    main()
