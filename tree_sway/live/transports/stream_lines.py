# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Lines out of a stream of bytes, and a question that is sent to instruments that wait for one."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
import math
import time

from tree_sway.live.transports.lines import Lines, LONGEST
from tree_sway.live.transports.link import Link
from tree_sway.live.transports.transport import Message

READ_FOR = 0.1
"""Interval at which a silent stream checks whether to end [s]."""
_LONGEST_LINE = 2.0
"""Time [s] in which a line of an instrument ends."""
_NO_END = 'bytes without the end of a line: is the baud rate that of the instrument?'


@dataclass(frozen=True)
class Question:
    """Bytes that an instrument answers, sent every some seconds [s]; none if they are empty."""

    text: bytes = b''
    every: float = 1.0


NO_QUESTION = Question()
"""For an instrument that sends by itself."""


def deliver_lines(
    receiver: Link,
    read: Callable[[], bytes],
    write: Callable[[bytes], object],
    question: Question,
) -> None:
    """
    Deliver the lines of a stream until the receiver is over.

    ``read`` returns what has come within `READ_FOR`, maybe nothing.
    """
    lines = Lines()
    due = time.monotonic()
    begun = math.inf  # arrival of the first bytes that no line has ended
    while not receiver.is_over:
        if question.text and time.monotonic() >= due:
            write(question.text)
            due = time.monotonic() + question.every
        data = read()
        if data:
            begun = min(begun, time.monotonic())
            if time.monotonic() - begun > _LONGEST_LINE:
                receiver.refuse(_NO_END)
        for line in lines.feed(data):
            begun = math.inf
            receiver.deliver(Message(line))
        if lines.dropped:
            receiver.refuse(f'a line of more than {LONGEST} bytes', lines.dropped)
            lines.dropped = 0
        receiver.rest()
