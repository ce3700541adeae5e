# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The one sender whose samples are used, of all that send to one address."""

from __future__ import annotations

from collections import deque

_LATELY = 8
"""Number of details of a sender that are kept in mind."""


class OneSender:
    """
    The first whose sample is good, until it has been silent for some periods.

    A sender has a name, such as its address, and a detail: the port that a datagram comes from, or
    a number in its messages. That tells two programs of one machine apart, but some open a new
    port, or count on, with each message: so details count as soon as one of them returns.
    """

    def __init__(self) -> None:
        self.name = self.detail = ''
        """The sender; empty before a good sample."""
        self.is_known = False
        """Whether there was a good sample."""
        self._counts = False
        self._lately: deque[str] = deque(maxlen=_LATELY)

    def admits(self, name: str, detail: str = '', *, is_live: bool) -> bool:
        """Whether a message may be used; ``is_live`` says that the present sender is not silent."""
        if not self.is_known or not is_live:
            return True
        return name == self.name and (not self._counts or detail == self.detail)

    def note(self, name: str, detail: str = '') -> bool:
        """Note a good sample of one that is admitted; return whether it is a new sender."""
        is_other = name != self.name or (self._counts and detail != self.detail)
        is_new = self.is_known and is_other
        if is_new:
            self._lately.clear()
            self._counts = False
        self._counts = self._counts or detail in self._lately
        self._lately.append(detail)
        self.name, self.detail, self.is_known = name, detail, True
        return is_new
