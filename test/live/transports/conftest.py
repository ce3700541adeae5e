# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A link under test: its messages and what it logs, with a deadline."""

from __future__ import annotations

from collections.abc import Callable, Iterator
import socket
import threading
import time
from typing import Any

import pytest

from tree_sway.live.transports.link import Link, Transport
from tree_sway.live.transports.transport import Message

DEADLINE = 10.0


class Heard:
    """Messages of a link, and what it logs."""

    def __init__(self, transport: Transport, **options: Any) -> None:
        self.messages: list[Message] = []
        self.said: list[str] = []
        self._more = threading.Condition()
        self.link = Link(transport, self._take, self._log, first_pause=0.02, **options)
        self.link.start()

    @property
    def data(self) -> list[bytes]:
        return [each.data for each in self.messages]

    def until(self, condition: Callable[[], Any]) -> None:
        end = time.monotonic() + DEADLINE
        with self._more:
            while not condition():
                assert time.monotonic() < end, (self.messages, self.said)
                self._more.wait(0.05)  # also for what is no message

    def _take(self, message: Message) -> None:
        with self._more:
            self.messages.append(message)
            self._more.notify_all()

    def _log(self, text: str) -> None:
        with self._more:
            self.said.append(text)
            self._more.notify_all()


@pytest.fixture
def hear() -> Iterator[Callable[..., Heard]]:
    made: list[Heard] = []

    def start(transport: Transport, **options: Any) -> Heard:
        made.append(Heard(transport, **options))
        return made[-1]

    yield start
    for each in made:
        each.link.stop()
        assert not each.link._thread.is_alive()


@pytest.fixture
def server() -> Iterator[socket.socket]:
    with socket.create_server(('127.0.0.1', 0)) as made:
        made.settimeout(DEADLINE)
        yield made


@pytest.fixture
def udp_port() -> int:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(('127.0.0.1', 0))
        return int(probe.getsockname()[1])


@pytest.fixture
def tcp_port() -> int:
    with socket.create_server(('127.0.0.1', 0)) as probe:
        return int(probe.getsockname()[1])
