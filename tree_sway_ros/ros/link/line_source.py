# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A thread that listens to an instrument and, whenever the link breaks, takes it up again."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Callable
from contextlib import aclosing, suppress
import importlib
import threading
from typing import Any

from tree_sway_ros.errors import MissingDependencyError
from tree_sway_ros.ros.link.address import Address
from tree_sway_ros.ros.link.lines import Lines

FIRST_PAUSE, LONGEST_PAUSE = 0.5, 30.0
"""Between two attempts [s]: doubled from the first to the longest while nothing comes."""
_CHUNK = 4096
_READ_FOR = 0.2  # [s]: so soon a serial port that is silent sees that it is to end
_BACKLOG = 64  # datagrams


class LineSource:
    """
    Listens to an instrument at an address; hands each line to `take`, in a thread of its own.

    A link without a byte for the time of `silence` [s] is given up and made anew, first after
    `first_pause` [s]. A `MissingDependencyError` tells that a serial port needs pyserial.
    """

    def __init__(
        self,
        address: Address,
        take: Callable[[str], None],
        log: Callable[[str], None],
        *,
        silence: float = 10.0,
        first_pause: float = FIRST_PAUSE,
    ) -> None:
        self._serial = _pyserial() if address.kind == 'serial' else None
        self._address = address
        self._take = take
        self._log = log
        self._silence = silence
        self._first_pause = first_pause
        self._loop = asyncio.new_event_loop()
        self._task: asyncio.Task[None] | None = None
        self._is_ending = False
        self._ending = asyncio.Event()
        self._thread = threading.Thread(target=self._run, name='instrument', daemon=True)
        self.is_up = False
        self.links = 0
        self.lines = 0
        self.failure = ''

    def start(self) -> None:
        """Start listening."""
        self._thread.start()

    def stop(self) -> None:
        """Stop listening; may be called twice."""
        self._is_ending = True  # `wait_for` swallows a cancellation that meets what it waits for
        if self._thread.is_alive():
            self._loop.call_soon_threadsafe(self._cancel)
            self._thread.join(timeout=5.0)

    def _cancel(self) -> None:
        self._ending.set()
        if self._task is not None:
            self._task.cancel()

    def _run(self) -> None:
        try:
            self._task = self._loop.create_task(self._listen())
            self._loop.run_until_complete(self._task)
        except asyncio.CancelledError:
            pass
        finally:
            self._loop.close()

    async def _listen(self) -> None:
        pause = self._first_pause
        while not self._is_ending:
            before, lines = self.lines, Lines()
            try:
                async with aclosing(_READERS[self._address.kind](self)) as chunks:
                    while not self._is_ending:
                        data = await asyncio.wait_for(anext(chunks), self._silence)
                        for line in lines.feed(data, is_whole=self._address.kind == 'udp'):
                            self.lines += 1
                            self._take(line)
            except asyncio.TimeoutError:
                self._lose(f'nothing for {self._silence:g} s')
            except StopAsyncIteration:
                self._lose('closed by the other side')
            except Exception as error:  # an instrument may fail in any way, and is tried again
                self._lose(f'{type(error).__name__}: {error}')
            pause = self._first_pause if self.lines > before else min(2.0 * pause, LONGEST_PAUSE)
            with suppress(asyncio.TimeoutError):
                await asyncio.wait_for(self._ending.wait(), pause)

    def _gain(self) -> None:
        self.is_up, self.failure = True, ''
        self.links += 1
        self._log(f'listening to {self._address}')

    def _lose(self, why: str) -> None:
        if self.is_up or why != self.failure:
            self._log(f'{self._address}: {why}; trying again')
        self.is_up, self.failure = False, why

    async def _tcp(self) -> AsyncIterator[bytes]:
        reader, writer = await asyncio.open_connection(self._address.place, self._address.number)
        try:
            self._gain()
            while data := await reader.read(_CHUNK):
                yield data
        finally:
            writer.close()

    async def _udp(self) -> AsyncIterator[bytes]:
        queue: asyncio.Queue[bytes] = asyncio.Queue(_BACKLOG)
        place = (self._address.place or '0.0.0.0', self._address.number)
        transport, _ = await self._loop.create_datagram_endpoint(
            lambda: _Datagrams(queue), local_addr=place
        )
        try:
            self._gain()
            while True:
                yield await queue.get()
        finally:
            transport.close()

    async def _port(self) -> AsyncIterator[bytes]:
        assert self._serial is not None
        port = self._serial.Serial(self._address.place, self._address.number, timeout=_READ_FOR)
        try:
            self._gain()
            while True:
                data = await self._loop.run_in_executor(None, port.read, 1)
                if data:
                    yield data + port.read(min(port.in_waiting, _CHUNK))
        finally:
            port.close()


class _Datagrams(asyncio.DatagramProtocol):
    """What a socket hears goes into a queue; when it is full, nowhere."""

    def __init__(self, queue: asyncio.Queue[bytes]) -> None:
        self._queue = queue

    def datagram_received(self, data: bytes, _sender: Any) -> None:
        if not self._queue.full():
            self._queue.put_nowait(data)


_READERS: dict[str, Callable[[LineSource], Any]] = {
    'tcp': LineSource._tcp,
    'udp': LineSource._udp,
    'serial': LineSource._port,
}


def _pyserial() -> Any:
    try:
        return importlib.import_module('serial')
    except ImportError:
        raise MissingDependencyError(
            'a serial port needs pyserial, which is not installed',
            cure='install python3-serial, or pip install pyserial',
        ) from None
