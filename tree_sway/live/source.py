# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A live source of wind or motion: a transport, and the reader of its messages."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
import math

from tree_sway.files.wind import Reading
from tree_sway.live.motion.motion_reading import MotionReading
from tree_sway.live.transports.link import Transport
from tree_sway.live.transports.transport import Message

WEST = 1.5 * math.pi
"""Bearing of a westerly [rad], for a wind without a direction."""


@dataclass(frozen=True)
class Source:
    """
    A transport and the reader of its messages.

    Parameters
    ----------
    transport
        Way in which messages arrive.
    read
        Function that returns what a message says, empty if it is about something else. It never
        raises.
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
    ticks
        Ticks of the sender's clock per second, for samples of motion; None to estimate them.
    mean
        Length of all its means [s] if its address gives it, 0 for the wind of instants.
    bearing
        Direction that a wind comes from where the instrument has no vane, clockwise from north
        [rad].
    is_without_vane
        Whether its address gives that direction.

    """

    transport: Transport
    read: Callable[[Message], Sequence[Reading | MotionReading]]
    name: str
    expects: str
    interval: float | None = None
    lasts: float | None = None
    messages: str = 'messages'
    ticks: float | None = None
    mean: float | None = None
    bearing: float = WEST
    is_without_vane: bool = False
