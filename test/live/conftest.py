# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Small servers that speak as makers' instruments and services do."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
import os
import socket
import struct
import threading
import time
from typing import Any

import pytest

from tree_sway.live.live_wind import LiveWind
from tree_sway.live.registry import open_source

DEADLINE = 20.0


class Heard:
    """Live wind of an address, and what it tells."""

    def __init__(self, address: str, **options: Any) -> None:
        self.said: list[str] = []
        self.wind = LiveWind(open_source(address), self.said.append, **options)
        self.wind.start()

    def until(
        self, condition: Callable[[], Any], meanwhile: Callable[[], object] = lambda: None
    ) -> None:
        """Wait for a condition, doing something again and again."""
        end = time.monotonic() + DEADLINE
        pause = threading.Event()
        while not condition():
            assert time.monotonic() < end, (self.said, self.wind.problem, self.wind.refused)
            meanwhile()
            pause.wait(0.02)


@pytest.fixture
def hear() -> Iterator[Callable[..., Heard]]:
    """Listen to an address; every thread has ended after the test."""
    made: list[Heard] = []

    def start(address: str, **options: Any) -> Heard:
        made.append(Heard(address, **options))
        return made[-1]

    yield start
    for each in made:
        begin = time.monotonic()
        each.wind.stop()
        assert not each.wind.link._thread.is_alive()
        assert time.monotonic() - begin < 3.0


@pytest.fixture
def port() -> int:
    """Port of this machine that is free for TCP and UDP."""
    while True:
        with socket.create_server(('127.0.0.1', 0)) as probe:
            number = int(probe.getsockname()[1])
            with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
                try:
                    other.bind(('127.0.0.1', number))
                except OSError:
                    continue
                return number


@pytest.fixture
def send() -> Iterator[Callable[[int, bytes], object]]:
    """Send a datagram to a port of this machine."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        yield lambda port, data: sender.sendto(data, ('127.0.0.1', port))


@pytest.fixture
def serve() -> Iterator[Callable[..., str]]:
    """Answer every request of HTTP by a body; return the address."""
    made: list[ThreadingHTTPServer] = []

    def start(body: bytes | Callable[[Any], bytes], status: int = 200) -> str:
        class Handler(BaseHTTPRequestHandler):
            def do_GET(self) -> None:
                data = body(self) if callable(body) else body
                self.send_response(status)
                self.end_headers()
                self.wfile.write(data)

            def log_message(self, *_: Any) -> None:
                """Stay silent."""

        server = ThreadingHTTPServer(('127.0.0.1', 0), Handler)
        server.daemon_threads = True
        threading.Thread(target=server.serve_forever, daemon=True).start()
        made.append(server)
        return f'127.0.0.1:{server.server_address[1]}'

    yield start
    for server in made:
        server.shutdown()
        server.server_close()


class Broker:
    """
    As much of a broker of MQTT 3.1.1 as a subscriber meets: packets of OASIS' standard, chapter 3.

    It publishes to the first subscriber, and keeps its topics.
    """

    def __init__(self) -> None:
        self.topics: list[str] = []
        self.packets: list[int] = []
        self._server = socket.create_server(('127.0.0.1', 0))
        self.port = int(self._server.getsockname()[1])
        self._link: socket.socket | None = None
        self._is_over = False
        threading.Thread(target=self._run, daemon=True).start()

    def publish(self, topic: str, payload: bytes) -> None:
        """Send a message of quality 0, once there is a subscriber."""
        if not self.topics or self._link is None:
            return
        name = topic.encode()
        body = struct.pack('>H', len(name)) + name + payload
        length = b''
        left = len(body)
        while True:
            left, part = left >> 7, left & 0x7F
            length += bytes([part | (0x80 if left else 0)])
            if not left:
                break
        self._link.sendall(b'\x30' + length + body)

    def drop(self) -> None:
        """Break the connection of the subscriber."""
        self.topics.clear()
        if self._link is not None:
            self._link.shutdown(socket.SHUT_RDWR)

    def close(self) -> None:
        self._is_over = True
        self._server.close()
        if self._link is not None:
            self._link.close()

    def _run(self) -> None:
        while not self._is_over:
            try:
                self._link, _ = self._server.accept()
                self._attend(self._link.makefile('rb'))
            except OSError:
                continue

    def _attend(self, stream: Any) -> None:
        assert self._link is not None
        while header := stream.read(1):
            length = shift = 0
            while True:
                part = stream.read(1)[0]
                length |= (part & 0x7F) << shift
                shift += 7
                if not part & 0x80:
                    break
            body = stream.read(length)
            kind = header[0] >> 4
            self.packets.append(kind)
            if kind == 1:
                self._link.sendall(b'\x20\x02\x00\x00')
            elif kind == 8:
                places, topics = 2, []
                while places < len(body):
                    size = struct.unpack_from('>H', body, places)[0]
                    topics.append(body[places + 2 : places + 2 + size].decode())
                    places += 3 + size
                self._link.sendall(bytes([0x90, 2 + len(topics)]) + body[:2] + bytes(len(topics)))
                self.topics += topics
            elif kind == 12:
                self._link.sendall(b'\xd0\x00')


@pytest.fixture
def broker() -> Iterator[Broker]:
    made = Broker()
    yield made
    made.close()


@pytest.fixture
def modbus() -> Iterator[Callable[..., str]]:
    """Answer Modbus TCP by registers, or by what a function makes of a request."""
    made: list[socket.socket] = []

    def registers_of(values: dict[int, int]) -> Callable[[bytes], bytes]:
        def answer(request: bytes) -> bytes:
            first, count = struct.unpack_from('>HH', request, 8)
            try:
                words = [values[first + k] for k in range(count)]
            except KeyError:
                return request[:4] + bytes([0, 3, request[6], request[7] | 0x80, 2])
            body = bytes([request[6], request[7], 2 * count]) + struct.pack(f'>{count}H', *words)
            return request[:4] + struct.pack('>H', len(body)) + body

        return answer

    def start(values: dict[int, int] | Callable[[bytes], bytes]) -> str:
        answer = registers_of(values) if isinstance(values, dict) else values
        server = socket.create_server(('127.0.0.1', 0))
        made.append(server)

        def run() -> None:
            while True:
                try:
                    with server.accept()[0] as link:
                        while request := link.recv(256):
                            link.sendall(answer(request))
                except OSError:
                    if server.fileno() < 0:
                        return

        threading.Thread(target=run, daemon=True).start()
        return f'127.0.0.1:{server.getsockname()[1]}'

    yield start
    for server in made:
        with suppress(OSError):
            server.shutdown(socket.SHUT_RDWR)
        server.close()


@contextmanager
def in_a_loop(start: Callable[[], Any]) -> Iterator[None]:
    """Run servers of asyncio on a thread, until the end of the context."""
    loop = asyncio.new_event_loop()
    ready = threading.Event()
    over = asyncio.Event()

    async def run() -> None:
        server = await start()
        ready.set()
        await over.wait()
        await server()

    thread = threading.Thread(target=loop.run_until_complete, args=(run(),), daemon=True)
    thread.start()
    assert ready.wait(DEADLINE)
    try:
        yield
    finally:
        loop.call_soon_threadsafe(over.set)
        thread.join(DEADLINE)
        loop.close()


@pytest.fixture
def serial_port() -> Iterator[tuple[str, Callable[[bytes], object]]]:
    """Open a pseudo-terminal in place of a serial port; its name, and what writes to it."""
    pty = pytest.importorskip('pty', reason='no pseudo-terminals here')
    ours, theirs = pty.openpty()
    yield os.ttyname(theirs), lambda data: os.write(ours, data)
    os.close(ours)
    os.close(theirs)
