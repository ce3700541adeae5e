# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A thread that listens to an instrument and reconnects when the link breaks."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
import importlib
import socket
import time
from typing import Any

from tree_sway.errors import MissingDependencyError
from tree_sway_ros.link.address import Address
from tree_sway_ros.link.lines import Lines
from tree_sway_ros.timing.worker import Worker

FIRST_PAUSE, LONGEST_PAUSE = 0.5, 30.0
"""Pause between two attempts [s]: doubled from the first to the longest while there is no data."""
_CONNECT_FOR = 5.0  # [s]
_READ_FOR = 0.1  # [s]: interval at which a silent link checks whether to end
_DATAGRAM = 65_536

Read = Callable[[], bytes | None]
"""Received bytes, empty after a timeout, None at the end of the link."""


@dataclass(eq=False)
class LineSource(Worker):
    """
    Connection to an instrument at an address; calls `take` with each line, in its own thread.

    A link without a byte for the time of `silence` [s] is closed and opened again, first after
    `first_pause` [s]. A serial port without pyserial raises a `MissingDependencyError`.
    """

    address: Address
    take: Callable[[str], None]
    log: Callable[[str], None]
    silence: float = 10.0
    first_pause: float = FIRST_PAUSE

    def __post_init__(self) -> None:
        """Prepare the thread."""
        if self.address.kind == 'serial':
            _pyserial()
        super().__init__('instrument')
        self.is_up = False
        self.links = self.lines = 0
        self.failure = ''

    def _run(self) -> None:
        pause = self.first_pause
        while not self._stopping.is_set():
            before = self.lines
            try:
                with _opened(self.address) as read:
                    why = self._listen(read)
            except Exception as error:  # an instrument may fail in any way, and is connected again
                why = f'{type(error).__name__}: {error}'
            if not self._stopping.is_set() and (self.is_up or why != self.failure):
                self.log(f'{self.address}: {why}; trying again')
            self.is_up, self.failure = False, why
            pause = self.first_pause if self.lines > before else min(2.0 * pause, LONGEST_PAUSE)
            self._stopping.wait(pause)

    def _listen(self, read: Read) -> str:
        """Read until the link ends; return the reason."""
        lines, latest = Lines(), time.monotonic()
        self.is_up, self.failure = True, ''
        self.links += 1
        self.log(f'listening to {self.address}')
        while not self._stopping.is_set():
            data = read()
            if data is None:
                return 'closed by the other side'
            if data:
                latest = time.monotonic()
            elif time.monotonic() - latest > self.silence:
                return f'nothing for {self.silence:g} s'
            for line in lines.feed(data, is_whole=self.address.kind == 'udp'):
                self.lines += 1
                self.take(line)
        return ''


@contextmanager
def _opened(address: Address) -> Iterator[Read]:
    """Open the link of an address."""
    where = address.place, address.number
    if address.kind == 'serial':
        with _pyserial().Serial(*where, timeout=_READ_FOR) as port:
            yield lambda: port.read(max(1, port.in_waiting))
        return
    is_tcp = address.kind == 'tcp'
    if is_tcp:
        link = socket.create_connection(where, _CONNECT_FOR)
    else:
        link = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    with link:
        if not is_tcp:
            link.bind(where)
        link.settimeout(_READ_FOR)

        def read() -> bytes | None:
            try:
                return link.recv(_DATAGRAM) or (None if is_tcp else b'')
            except TimeoutError:
                return b''

        yield read


def _pyserial() -> Any:
    try:
        return importlib.import_module('serial')
    except ImportError:
        raise MissingDependencyError(
            'a serial port needs pyserial, which is not installed',
            cure='install python3-serial, or pip install pyserial',
        ) from None
