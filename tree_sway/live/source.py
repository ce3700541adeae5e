# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A live source of wind: a transport, and the reader of its messages."""

from __future__ import annotations

from dataclasses import dataclass

from tree_sway.live.reading import Read
from tree_sway.live.transports.transport import Transport


@dataclass(frozen=True)
class Source:
    """
    A transport and the reader of its messages.

    Parameters
    ----------
    transport
        Way in which messages arrive.
    read
        Function that reads a message.
    name
        Short name for viewers, such as ``open-meteo``.
    expects
        Expected content of its messages, for the report of unknown ones.
    interval
        Averaging time of its winds [s]; 0 for instantaneous ones, None for the time between two
        messages.
    lasts
        Time for which a mean is used [s]; three intervals if None.
    messages
        Word for its messages in reports.

    """

    transport: Transport
    read: Read
    name: str
    expects: str
    interval: float | None = None
    lasts: float | None = None
    messages: str = 'messages'
