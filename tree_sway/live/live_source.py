# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A live source from its start to its stop: connection, counts, and the news why nothing comes.

Wind and motion differ in what they do with a message; that is in `LiveWind` and `LiveMotion`.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
import math
import threading
import time
from typing import ClassVar

from tree_sway.errors import shown
from tree_sway.live.one_sender import OneSender
from tree_sway.live.source import Source
from tree_sway.live.transports.link import Link, LONGEST_PAUSE
from tree_sway.live.transports.transport import Log, Message

_LOOK = 0.5
"""Interval at which it is looked whether anything comes [s]."""
_SHOWN_CAUSES = 3
_SHOWN_BYTES, _SHOWN_LETTERS = 300, 120
"""Length of a message that is shown, before and after what cannot be printed is replaced."""


class LiveSource(ABC):
    """
    A source, from `start` to `stop`.

    Parameters
    ----------
    source
        Its transport, and the reader of its messages.
    log
        Function called with a line of news, from the source's thread.
    silence
        As in `Link`.

    """

    _patience: ClassVar[Mapping[str, float]]
    """Time [s] in each state after which it is told why nothing comes; in others it is not."""
    _longest_pause = LONGEST_PAUSE

    def __init__(self, source: Source, log: Log, silence: float | None = None) -> None:
        self.accepted = self.other = 0
        """Numbers of samples, and of messages that are about something else."""
        self._source = source
        self._log = log
        self._last = ''
        self._expires = -math.inf  # time after which its newest sample no longer counts
        self._senders = OneSender()
        self._followed = -math.inf
        self.link = Link(
            source.transport,
            self._receive,
            log,
            silence,
            longest_pause=self._longest_pause,
            admits=self._admits,
        )
        """The connection, with its state and counts."""
        self.refused = self.link.refused
        """Numbers of samples and messages that were refused, by cause."""

    def start(self) -> None:
        """Start to listen."""
        self.link.start()
        threading.Thread(target=self._watch, name='live source', daemon=True).start()

    def stop(self) -> None:
        """Stop; the thread ends by itself if it is busy."""
        self.link.stop()

    @property
    def state(self) -> str:
        """State: ``connecting``, ``waiting``, ``unknown`` messages, ``live`` or ``stale``."""
        if self.accepted:
            return 'live' if time.monotonic() < self._expires else 'stale'
        if self.link.messages or self.refused:
            return 'unknown'
        return 'waiting' if self.link.is_up else 'connecting'

    @property
    @abstractmethod
    def problem(self) -> str:
        """Why nothing comes of it; empty if something does."""

    @abstractmethod
    def _take(self, message: Message) -> None:
        """Read a message; called by the link's thread."""

    def _receive(self, message: Message) -> None:
        self._last = shown(message.data[:_SHOWN_BYTES].decode('utf-8', 'replace'), _SHOWN_LETTERS)
        self._take(message)

    def _follows(self, sender: str) -> bool:
        """Whether a good sample is of the sender that is followed; count and name the others."""
        now = time.monotonic()
        if self._senders.admit(sender, now):
            self._followed = now
            return True
        cause = f'another sender, {shown(sender, _SHOWN_LETTERS)}'
        if self.link.refuse(cause):
            self._log(f'refused: {cause}, until {self._senders.current} is silent')
        return False

    def _admits(self, message: Message) -> bool:
        """Whether to read a message: not that of one who was refused, which may be a flood."""
        senders = self._senders
        is_live = time.monotonic() - self._followed <= senders.patience
        # One address may pass on several instruments, whose messages alone tell which.
        origin = message.origin
        is_shared = not origin or f'{senders.current} '.startswith(f'{origin} ')
        is_other = origin in senders.refused and not is_shared
        return not (is_live and is_other) or self._follows(message.origin)

    @property
    def refused_text(self) -> str:
        """Number of what was refused, with the first cause, to stand behind a count of samples."""
        if not self.refused:
            return ''
        return f', {self.refused.total()} refused: {next(iter(self.refused))}'

    def _why_nothing(self) -> str:
        """Why no sample was accepted so far."""
        link = self.link
        if not link.is_up:
            return f'no connection to {link.transport}: {link.failure or "not yet"}'
        if not link.messages and not self.refused:
            return f'listening to {link.transport}: nothing has come yet'
        number = max(link.messages, self.refused.total())
        came = f'{number} {self._source.messages} came'
        if self.refused:
            causes = ', '.join(list(self.refused)[:_SHOWN_CAUSES])
            last = f'; the last: {self._last}' if self._last else ''
            return f'{came}, all were refused: {causes}{last}'
        return (
            f'{came}, none was understood, the last: {self._last}; expected {self._source.expects}'
        )

    def _watch(self) -> None:
        """Tell once why nothing comes, as soon as it is known, until it does."""
        state = ''
        since = 0.0
        told = ''
        while not self.link.is_stopping and not self.accepted:
            if self.state != state:
                state = self.state
                since = time.monotonic()
            waited = time.monotonic() - since
            if state != told and waited >= self._patience.get(state, math.inf):
                told = state
                self._log(self._news())
            self.link.pause(_LOOK)

    def _news(self) -> str:
        """Return the problem as a line for the terminal."""
        return self.problem
