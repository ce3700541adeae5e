# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Other publishers on a topic that one node alone should publish on."""

from __future__ import annotations

from collections.abc import Sequence
import time

GHOST = 25.0
"""A node that was killed is seen for 20 s; after this time [s] one of its name is a second one."""


class Rivals:
    """Looks at the publishers of a topic again and again."""

    def __init__(self) -> None:
        self.said: set[str] = set()
        self._since: float | None = None

    def warning(self, topic: str, names: Sequence[str]) -> str:
        """Return what is wrong with the publishers, by their full names; empty if nothing is."""
        if len(names) < 2:
            self._since = None
            return ''
        now = time.monotonic()
        self._since = now if self._since is None else self._since
        if len(set(names)) == 1 and now - self._since < GHOST:
            return ''  # of a node that was killed and started again
        together = ' and '.join(sorted(names))
        return f'{len(names)} nodes publish {topic}: {together}; what they send mixes'
