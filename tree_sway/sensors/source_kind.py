# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A kind of source in the registry, and a source that is opened."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from tree_sway.sensors.reading import Read
from tree_sway.sensors.source_address import SourceAddress
from tree_sway.sensors.transports.transport import Transport


@dataclass(frozen=True)
class Source:
    """
    A transport and the reader of its messages.

    Parameters
    ----------
    transport
        Way in which messages arrive.
    read
        What they say.
    name
        Short name for viewers, such as ``open-meteo``.
    expects
        What its messages should have, for the report of unknown ones.
    interval
        Length of the means that it sends [s]; 0 for the wind of instants, None where the time
        between two messages decides.
    lasts
        Time for which a mean is used [s]; three intervals if None.
    messages
        Word for its messages.

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
        First words of its addresses.
    form
        Its address as an example.
    what
        Instruments, in a few words.
    open
        Function that makes a source of an address; it raises a `TreeSwayError`.

    """

    schemes: tuple[str, ...]
    form: str
    what: str
    open: Callable[[SourceAddress], Source]  # noqa: A003
