# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Who must listen before a record begins, and who must have heard before time goes on.

A replay is exact where every sample has reached the solver before the tick of the clock that the
solver steps to, and where the first tick finds everybody listening.

"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Mapping

from tree_sway_ros.errors import ParameterError

SETTLING = 0.5
"""From the moment all are seen to the first sample [s]: they must see us as well."""


def required(text: str) -> dict[str, int]:
    """
    Read who must listen: topics parted by spaces, each with a number of subscribers if not one.

    Raises
    ------
    ParameterError
        If a number is none.

    """
    wanted: dict[str, int] = {}
    for word in text.split():
        topic, _, number = word.partition(":")
        if not topic or (number and not number.isdecimal()):
            raise ParameterError(
                f"'{word}' names no topic and number of subscribers",
                where="parameter 'wait_for'",
                cure="give for example 'wind wind/filtered /clock:2'",
            )
        wanted[topic] = int(number or 1)
    return wanted


class Audience:
    """
    Waits for subscribers.

    Parameters
    ----------
    wanted
        Number of subscribers by topic.
    count
        How many a topic has.
    log
        Called with a line that says who is missing, when that changes.

    """

    def __init__(
        self, wanted: Mapping[str, int], count: Callable[[str], int], log: Callable[[str], None]
    ) -> None:
        self._wanted = wanted
        self._count = count
        self._log = log
        self._said = ""
        self._complete: float | None = None

    def is_there(self) -> bool:
        """Whether all have listened for `SETTLING`; asked again and again until true."""
        here = {topic: self._count(topic) for topic in self._wanted}
        missing = [
            f"{topic} ({here[topic]} of {number})"
            for topic, number in self._wanted.items()
            if here[topic] < number
        ]
        if missing:
            self._complete = None
            self._say(f"waiting for subscribers of {', '.join(missing)}")
            return False
        if self._complete is None:
            self._complete = time.monotonic()
        return not self._wanted or time.monotonic() - self._complete >= SETTLING

    def _say(self, text: str) -> None:
        if text != self._said:
            self._said = text
            self._log(text)


class Answers:
    """
    Waits until what was sent has come back.

    Parameters
    ----------
    patience
        Longest wait in [s]: a sample that is refused on the way never comes back.

    """

    def __init__(self, patience: float = 1.0) -> None:
        self._patience = patience
        self._more = threading.Condition()
        self._heard = 0
        self._sent = 0
        self.missing = 0

    def sent(self, stamp: int) -> None:
        """Note the stamp of a sample that was sent in [ns]."""
        self._sent = stamp

    def heard(self, stamp: int) -> None:
        """Note the stamp of a sample that came back in [ns]; another thread may call this."""
        with self._more:
            self._heard = max(self._heard, stamp)
            self._more.notify_all()

    def wait(self) -> bool:
        """Wait for the newest sample that was sent; return whether it came back."""
        with self._more:
            came = self._more.wait_for(
                lambda: self._heard >= self._sent - _ROUNDING, self._patience
            )
        if not came:
            self.missing += 1
            self._heard = max(self._heard, self._sent)  # waited for once
        return came


_ROUNDING = 2_000
"""Of a time that was in [s] on its way, in [ns]."""
