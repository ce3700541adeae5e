# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A connected page: what it asked for, and what it is sent next.

A client gets a frame only for a credit that it gave, and always the newest one, so that a slow
client gets fewer frames, not old ones.
"""

from __future__ import annotations

import asyncio
from collections import deque
import json
import math
import time

from aiohttp import web

from tree_sway.page.published import Published
from tree_sway.stream import FRAME_SIZE, Json, part_of_frame

_MOST_CREDIT = 64
"""Largest number of frames in transit to one client."""

SLOWEST, FASTEST = 0.1, 1000.0
"""Range of frames per second of a client [Hz]."""

_IDLE_TIME = 60.0
"""Time without a message after which a client is closed [s]; a page sends several a second."""

STATE_PERIOD = 5.0
"""Interval of coordinates for a client that solves by itself [s]."""

MOST_IN_STATE = 600
"""Number of coordinates that are sent to it each time, in turn."""

_FIRST_STATES = 2
"""States that it is sent whole to begin with: two, for the rates."""

_SEND_TIMEOUT = 5.0
_MOST_TEXTS = 16
_LARGEST_PING = 1e15


class PageClient:
    """
    A connected page: its credit, its rate, and the texts that wait for it.

    Parameters
    ----------
    socket, transport
        Connection of the page.
    may_control
        Whether it may change the wind and the tree.

    """

    def __init__(
        self,
        socket: web.WebSocketResponse,
        transport: asyncio.Transport | None,
        *,
        may_control: bool = False,
    ) -> None:
        self.socket = socket
        self.may_control = may_control
        self.hello = ''
        """First text, which is never lost."""
        self.wake = asyncio.Event()
        """Set when something may have to be sent."""
        self.last_heard = time.monotonic()
        self.missed = 0
        """
        Number of frames that it asked for and was not sent, as it, the line or this machine was
        late.
        """
        self._transport = transport
        self._texts: deque[str] = deque(maxlen=_MOST_TEXTS)
        self._sending_since = math.inf
        # Frames: how many more may be sent, how often, and which was the last.
        self._credit = 0
        self._period = 0.0
        self._next_due = 0.0
        self._timer: asyncio.TimerHandle | None = None
        self._description = b''
        self._sent = -1
        # A client that solves by itself gets the wind, and the coordinates a part at a time.
        self._wants_wind = self._wants_nothing_else = self._is_solving = False
        self._n_states = 0
        self._next_state = 0.0
        self._first = 0

    def say(self, content: Json) -> None:
        """Queue a text; a client that does not read loses the oldest, but not its hello."""
        self._texts.append(json.dumps(content))
        self.wake.set()

    def is_stuck(self, now: float) -> bool:
        """Whether the client has neither sent nor read for too long."""
        return now > min(self.last_heard + _IDLE_TIME, self._sending_since + _SEND_TIMEOUT)

    def drop(self) -> None:
        """Close the connection without waiting for the client to read."""
        if self._transport is not None:
            self._transport.abort()

    def stop_timer(self) -> None:
        """Cancel the timer of the next frame."""
        if self._timer is not None:
            self._timer.cancel()

    def take(self, message: Json) -> None:
        """
        Take what a message says of the frames that the client wants, and answer its ping.

        Raises
        ------
        ValueError
            A number out of its range.

        """
        if 'credit' in message:
            credit = self._credit + _number(message, 'credit', -_MOST_CREDIT, math.inf)
            self._credit = int(max(0, min(credit, _MOST_CREDIT)))
        if 'rate' in message:
            self._period = 1.0 / _number(message, 'rate', SLOWEST, FASTEST)
        if 'ping' in message:
            ping = _number(message, 'ping', -_LARGEST_PING, _LARGEST_PING)
            self.say({'pong': ping, 'time': time.time_ns() / 1e6})
        wind = message.get('wind')
        if wind is True:
            self._wants_wind = True
            self._description = b''  # sent again, with the tables
        self._wants_nothing_else |= wind == 'only'
        self.wake.set()

    async def send(self, published: Published) -> None:
        """Send all that is due, each time the client is woken, until it is closed."""
        while not self.socket.closed:
            await self.wake.wait()
            self.wake.clear()
            # `is_stuck` looks at this twice a second: a timer per frame would cost memory.
            self._sending_since = time.monotonic()
            await self.send_due(published)
            self._sending_since = math.inf

    async def send_due(self, published: Published) -> None:
        """Send texts, a new description, and the newest frame where there is credit for it."""
        if self.hello:
            hello = self.hello
            self.hello = ''
            await self.socket.send_str(hello)
        while self._texts:
            await self.socket.send_str(self._texts.popleft())
        if self._description is not published.description:
            self._description = published.description
            await self.socket.send_bytes(self._description)
            if self._wants_wind:
                await self._send_tables(published)
        number, frame = published.newest
        is_new = number != self._sent and frame and self._description
        if self._credit <= 0 or not is_new:
            return
        loop = asyncio.get_running_loop()
        now = loop.time()
        # Half a period early is on time: the solver's frames and the client's rate have no common
        # grid.
        if now < self._next_due - 0.5 * self._period:
            if self._timer is None:
                self._timer = loop.call_at(self._next_due, self._ring)
            return
        if self._sent >= 0 and self._period:
            late = int((now - self._next_due) / self._period)
            self.missed += min(max(late, 0), number - self._sent - 1)
        self._next_due = max(self._next_due + self._period, now)
        self._credit -= 1
        self._sent = number
        if self._is_solving or self._wants_nothing_else:
            frame = self.thinned(frame, now)
        await self.socket.send_bytes(frame)

    def thinned(self, frame: bytes, now: float) -> bytes:
        """Return the part of a frame for a client that solves: wind, sometimes coordinates."""
        wind_alone = part_of_frame(frame, 0, 0)
        if self._wants_nothing_else:
            return wind_alone
        if self._n_states < _FIRST_STATES:
            self._n_states += 1
            self._next_state = now + STATE_PERIOD
            return frame
        if now < self._next_state:
            return wind_alone
        self._next_state = now + STATE_PERIOD
        part = part_of_frame(frame, self._first, MOST_IN_STATE)
        self._first += MOST_IN_STATE
        n_coordinates = int.from_bytes(frame[FRAME_SIZE - 2 : FRAME_SIZE], 'little')
        if self._first >= n_coordinates:
            self._first = 0
        return part

    async def _send_tables(self, published: Published) -> None:
        """Send the tables, or a message that there are none; then every state is sent."""
        tables = await asyncio.to_thread(published.tables)
        self._is_solving = tables is not None
        self._n_states = 0
        if tables is None:
            reason = 'this scene cannot be solved by clients: it is sent state by state'
            self.say({'refused': {'name': 'wind', 'reason': reason}})
            return
        await self.socket.send_bytes(tables)
        if gusts := published.gusts():
            await self.socket.send_str(json.dumps({'gusts': gusts}))

    def _ring(self) -> None:
        self._timer = None
        self.wake.set()


def _number(message: Json, name: str, low: float, high: float) -> float:
    """Return an entry that is a number within a range, else raise."""
    value = message[name]
    if type(value) not in (int, float) or not low <= value <= high:
        raise ValueError(f'{name} out of {low:g} .. {high:g}')
    return float(min(value, _LARGEST_PING))
