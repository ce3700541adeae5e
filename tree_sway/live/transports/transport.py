# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Messages that a transport delivers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

Log = Callable[[str], None]
"""Function that is told a line of news."""


def ignore(_: object) -> None:
    """Do nothing with a reading: for a source whose readings no one else hears."""


@dataclass(frozen=True, slots=True)
class Message:
    """
    One message of an instrument: a line without its end, a datagram, a body of HTTP.

    ``origin`` tells its sender: the topic of MQTT, or the address that sent a request, with
    the port of a datagram; it is empty where there is one sender only.
    """

    data: bytes
    origin: str = ''
