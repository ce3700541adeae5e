# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A sample of a motion sensor, and a live source of them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from tree_sway.live.reading import Refusal
from tree_sway.live.transports.transport import Message, Transport

Numbers = tuple[float, ...]


@dataclass(frozen=True, slots=True)
class MotionReading:
    """
    One sample, in the sensor's own frame (REP-145); what it does not measure is None.

    Parameters
    ----------
    time
        Time on the clock of the sender, in its own unit; None for that of arrival.
    acceleration
        Acceleration, x y z, in [m/s^2] or in g.
    rate
        Angular rate, x y z, in [rad/s] or in degrees per second.
    orientation
        Rotation to east, north, up as x y z w.

    """

    time: float | None
    acceleration: Numbers | None = None
    rate: Numbers | None = None
    orientation: Numbers | None = None

    @property
    def quantities(self) -> tuple[str, ...]:
        """Names of what is measured."""
        names = ('acceleration', 'rate', 'orientation')
        return tuple(name for name in names if getattr(self, name) is not None)


ReadMotion = Callable[[Message], Sequence[MotionReading | Refusal]]
"""What a message says; empty if it is not about motion. Never raises."""


@dataclass(frozen=True)
class MotionSource:
    """
    A transport and the reader of its messages, as `Source` for the wind.

    Parameters
    ----------
    transport
        Way in which messages arrive.
    read
        Function that reads a message.
    name
        Short name for viewers, such as ``phyphox``.
    expects
        Expected content of its messages, for the report of unknown ones.
    ticks
        Ticks of the sender's clock per second; None to estimate them.

    """

    transport: Transport
    read: ReadMotion
    name: str
    expects: str
    ticks: float | None = None
