# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A live source of wind, and the kinds of them that the registry makes from addresses."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from tree_sway.live.reading import Read
from tree_sway.live.source_address import SourceAddress
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


@dataclass(frozen=True)
class SourceKind:
    """
    A kind of source.

    Parameters
    ----------
    schemes
        Schemes of its addresses, such as ``udp``.
    form
        Example of an address.
    what
        Instruments that it is for, in a few words.
    open
        Function that makes a source of an address; it raises a `TreeSwayError`.

    """

    schemes: tuple[str, ...]
    form: str
    what: str
    open: Callable[[SourceAddress], Source]  # noqa: A003
