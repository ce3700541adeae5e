# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Interfaces of a transport: messages, and whom they are delivered to."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol


@dataclass(frozen=True, slots=True)
class Message:
    """
    One message of an instrument: a line without its end, a datagram, a body of HTTP.

    ``origin`` tells its sender: the topic of MQTT, or the address that sent a request, with
    the port of a datagram; it is empty where there is one sender only.
    """

    data: bytes
    origin: str = ''


class Receiver(Protocol):
    """Receiver of a transport's messages, and the end of its work."""

    @property
    def is_over(self) -> bool:
        """Whether to end: on request, or as nothing has come for too long; asked often."""

    def opened(self) -> None:
        """Note that the connection is made."""

    def deliver(self, message: Message) -> None:
        """Deliver a message, and rest as `rest`."""

    def refuse(self, cause: str, count: int = 1) -> object:
        """Count messages that are not delivered, by their cause."""

    def rest(self) -> None:
        """Rest if receiving took too much of the processor; called often, whatever comes."""

    def pause(self, seconds: float) -> None:
        """Wait some seconds [s], or until the end is requested."""


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

    def listen(self, receiver: Receiver) -> None:
        """
        Connect and deliver messages until the receiver is over.

        Any exception means that the connection broke; a `ConnectionError` has the reason as text.
        """
