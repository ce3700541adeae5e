# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Who must listen before a record begins, and who must have heard before time goes on.

A replay is exact where the first tick of the clock finds everybody listening, where every sample
has reached the solver before it steps to that time, and where it skips no frame to keep up.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
import threading
import time

from tree_sway.errors import ParameterError

LONGEST_LEAD = 0.4
"""A sample goes ahead by no more than this [s]; gates take what is farther ahead for a fault."""
_GIVE_UP = 450_000_000
"""A clock this far beyond a wait [ns] no longer waits; below the longest step of a pacer."""
_POLL = 0.0005
_REPEAT = 0.1
"""Time from one sending of the last tick to the next [s]."""
SETTLING = 0.5
"""Time from the moment all are seen to the first sample [s]: they must see us as well."""


def required(text: str) -> dict[str, int]:
    """
    Read who must listen: topics parted by spaces, each with a number of subscribers if not one.

    A `ParameterError` is raised for what is no number.
    """
    wanted: dict[str, int] = {}
    for word in text.split():
        topic, _, number = word.partition(':')
        if not topic or (number and not number.isdecimal()):
            raise ParameterError(
                f"'{word}' names no topic and number of subscribers",
                where="parameter 'wait_for'",
                cure="give for example 'wind wind/filtered /clock:2'",
            )
        wanted[topic] = int(number or 1)
    return wanted


class Audience:
    """Waits for numbers of subscribers by topic; logs who is missing, when that changes."""

    def __init__(
        self, wanted: Mapping[str, int], count: Callable[[str], int], log: Callable[[str], None]
    ) -> None:
        self._wanted = wanted
        self._count = count
        self._log = log
        self._said = ''
        self._complete: float | None = None

    def is_there(self) -> bool:
        """Whether all have listened for `SETTLING`; asked again and again until true."""
        here = {topic: self._count(topic) for topic in self._wanted}
        missing = [
            f'{topic} ({here[topic]} of {number})'
            for topic, number in self._wanted.items()
            if here[topic] < number
        ]
        if missing:
            self._complete = None
            text = f'waiting for subscribers of {", ".join(missing)}'
            if text != self._said:
                self._said = text
                self._log(text)
            return False
        if self._complete is None:
            self._complete = time.monotonic()
        return not self._wanted or time.monotonic() - self._complete >= SETTLING


class Answers:
    """
    Holds the clock until those who follow have come as far, but for a slack [ns] and a last step.

    After the ``patience`` [s] time goes on, until something is heard again.
    """

    def __init__(self, slack: int, patience: float = 3.0) -> None:
        self._slack = slack
        self._patience = patience
        self._more = threading.Condition()
        self._heard = self._step = self._sent = 0
        self._is_deaf = False
        self.missing = 0

    def sent(self, time_ns: int) -> None:
        """Note what must be answered: the time of a sample, or of the clock, in [ns]."""
        self._sent = time_ns

    def heard(self, time_ns: int) -> None:
        """Note the time of an answer in [ns]; another thread may call this."""
        with self._more:
            self._step = max(0, time_ns - self._heard) if self._heard else 0
            self._heard = time_ns
            self._is_deaf = False
            self._more.notify_all()

    def wait(self) -> bool:
        """Wait for the answer to what was sent last; return whether it came."""
        with self._more:
            came = self._more.wait_for(self._has_come, 0.0 if self._is_deaf else self._patience)
            self.missing += not (came or self._is_deaf)
            self._is_deaf = not came
        return came

    def end(self, send: Callable[[int], None]) -> None:
        """Send the last time, in [ns], again until it is answered, or nobody seems to hear it."""
        end = time.monotonic() + (0.0 if self._is_deaf else self._patience)
        with self._more:
            while self._heard < self._sent - self._step and time.monotonic() < end:
                send(self._sent)
                self._more.wait(_REPEAT)

    def _has_come(self) -> bool:
        return self._heard >= self._sent - self._slack - self._step


class Reach:
    """How far samples reach that are sent ahead of the clock, as those of an exact replay are."""

    def __init__(self, patience: float = 3.0) -> None:
        self._patience = patience
        self._newest = 0
        self._is_ahead = False
        self._is_over = threading.Event()

    def add(self, stamp: int) -> None:
        """Note a sample's stamp in [ns]; after a long gap it was not sent with the one before."""
        self._is_ahead = 0 < stamp - self._newest <= LONGEST_LEAD * 1e9
        self._newest = stamp

    def wait(self, time_ns: int, take: Callable[[], None], now: Callable[[], int]) -> None:
        """
        Take samples until they reach a time in [ns]; just once before the first two of them.

        What was refused on the way never comes: there the clock is let go on, and so is the wait.
        """
        end = time.monotonic() + self._patience
        take()
        while self._is_ahead and self._newest < time_ns and not self._is_over.wait(_POLL):
            take()
            if now() > time_ns + _GIVE_UP or time.monotonic() > end:
                self._is_ahead = False

    def end(self) -> None:
        """Wait no more; another thread calls this."""
        self._is_over.set()

    def forget(self) -> None:
        """Begin again, at another time."""
        self._newest, self._is_ahead = 0, False
