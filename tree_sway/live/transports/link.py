# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A transport, and the thread that listens to it and connects again when it breaks."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
import time
from typing import Protocol

from tree_sway.live.transports.link_failure import failure_text
from tree_sway.live.transports.pace import MOST, Pace
from tree_sway.live.transports.transport import Log, Message
from tree_sway.worker import Worker

FIRST_PAUSE, LONGEST_PAUSE = 0.5, 30.0
"""Pause between two attempts [s]: doubled from the first to the longest while there is no data."""
_MOST_CAUSES = 20
"""Number of causes of refusals that are counted apart."""
_TOO_MANY = f'more than {MOST:g} messages per second'


class Transport(Protocol):
    """
    A way in which messages arrive.

    ``silence`` is the time [s] without a message after which the connection is made again.
    """

    @property
    def silence(self) -> float:
        """Longest time without a message [s]."""

    def __str__(self) -> str:
        """Return its address as text, without a password."""

    def listen(self, receiver: Link) -> None:
        """
        Connect and deliver messages until the receiver is over.

        Any exception means that the connection broke; a `ConnectionError` has the reason as text.
        """


@dataclass(eq=False)
class Link(Worker):
    """
    Connection over a transport; calls `take` with each message, in its own thread.

    A connection without a message for the time of `silence` [s], by default the transport's, is
    closed and opened again at once, which is told the first time. After a failure, as of `take`,
    that takes `first_pause` [s], and twice as long each time up to `longest_pause` [s].
    """

    transport: Transport
    take: Callable[[Message], None]
    log: Log
    silence: float | None = None
    first_pause: float = FIRST_PAUSE
    longest_pause: float = LONGEST_PAUSE
    admits: Callable[[Message], bool] = lambda _message: True
    """Whether to hand on a message; asked first, so that others do not use up the rate."""

    def __post_init__(self) -> None:
        """Prepare the thread."""
        super().__init__('instrument')
        self.is_up = False
        """Whether there is a connection."""
        self.connections = self.messages = 0
        self.failure = ''
        """Reason of the last failure; empty while there is a connection."""
        self.refused = Counter[str]()
        """Numbers of what was refused, by cause."""
        self._limit = self.transport.silence if self.silence is None else self.silence
        self._latest = 0.0
        self._is_quiet = False
        """Whether it was opened again as nothing came, and nothing has come since."""
        self._pace = Pace()

    @property
    def is_over(self) -> bool:
        """Whether the transport is to end: on request, or as nothing came; asked often."""
        return self.is_stopping or self._is_silent

    def opened(self) -> None:
        """Note that the connection is made."""
        self._latest = time.monotonic()
        self.is_up = True
        self.failure = ''
        self.connections += 1
        if not self._is_quiet:
            self.log(f'listening to {self.transport}')

    def deliver(self, message: Message) -> None:
        """Count a message and hand it on, unless too many come."""
        self._latest = time.monotonic()
        self.messages += 1
        if self._is_quiet:
            self._is_quiet = False
            if self.messages > 1:
                self.log(f'{self.transport}: messages come again')
        if self.admits(message):
            if self._pace.admits(len(message.data)):
                self.take(message)
            else:
                self.refuse(_TOO_MANY)
        self.rest()

    def rest(self) -> None:
        """Rest if the thread took more than its share of the processor; called often."""
        if rest := self._pace.rest:
            self.pause(rest)

    def refuse(self, cause: str, count: int = 1) -> bool:
        """Count what is refused, by the first causes that occur; return whether one is new."""
        is_new = cause not in self.refused
        if is_new and len(self.refused) >= _MOST_CAUSES:
            is_new = False
            cause = 'other causes'
        self.refused[cause] += count
        return is_new

    def pause(self, seconds: float) -> None:
        """Wait some seconds [s], or until the thread is stopped."""
        self._stopping.wait(seconds)

    @property
    def _is_silent(self) -> bool:
        return self.is_up and time.monotonic() - self._latest > self._limit

    def _run(self) -> None:
        pause = self.first_pause
        self._pace.begin()
        while not self.is_stopping:
            before = self.messages
            is_silent = False
            try:
                self.transport.listen(self)
                is_silent = self._is_silent
                why = f'nothing for {self._limit:g} s' if is_silent else 'it ended'
            except Exception as error:  # an instrument may fail in any way
                why = failure_text(error)
            is_told = self._is_quiet if is_silent else not self.is_up and why == self.failure
            if not (self._stopping.is_set() or is_told):
                self.log(f'{self.transport}: {why}; trying again')
            self.is_up = False
            self.failure = why
            self._is_quiet = is_silent
            was_there = is_silent or self.messages > before
            pause = self.first_pause if was_there else min(2.0 * pause, self.longest_pause)
            self._stopping.wait(0.0 if is_silent else pause)
