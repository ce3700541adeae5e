# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Limits of a source: the rate of its messages, and the time that they take."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
import socket
import threading
import time
from types import SimpleNamespace

import pytest

from tree_sway.live.transports import pace
from tree_sway.live.transports.pace import MOST, Pace
from tree_sway.live.transports.tcp import Tcp
from tree_sway.live.transports.udp import Udp


class Clock:
    """Time of the test, of the wall and of the processor [s]."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.now = self.spent = 0.0
        named = SimpleNamespace(monotonic=lambda: self.now, thread_time=lambda: self.spent)
        monkeypatch.setattr(pace, 'time', named)


def test_a_fast_instrument_is_within_the_rate_for_ever(monkeypatch) -> None:
    clock = Clock(monkeypatch)
    limit = Pace()
    for k in range(20_000):
        clock.now = k / 900.0
        assert limit.admits(80)


@pytest.mark.parametrize('size', [10, 4000])
def test_a_flood_is_cut_to_the_rate(monkeypatch, size: int) -> None:
    clock = Clock(monkeypatch)
    limit = Pace()
    taken = 0
    for k in range(200_000):
        clock.now = k / 20_000.0  # for 10 s
        taken += limit.admits(size)
    assert taken == pytest.approx((10.0 * MOST + 1500.0) / (1.0 + size / 1024.0), rel=0.01)


def test_a_document_of_a_mebibyte_is_admitted(monkeypatch) -> None:
    Clock(monkeypatch)
    assert Pace().admits(2**20)


def test_a_thread_takes_a_quarter_of_a_processor(monkeypatch) -> None:
    clock = Clock(monkeypatch)
    limit = Pace()
    limit.begin()
    for _ in range(10_000):
        limit.admits(10)
        clock.spent += 0.001
        clock.now += 0.001 + limit.rest
    assert clock.spent / clock.now == pytest.approx(0.25, rel=0.02)


@contextmanager
def flood_of(send: Callable[[], object]) -> Iterator[None]:
    """Send all the time, to the end of a block however that ends."""
    over = threading.Event()

    def flood() -> None:
        while not over.is_set():
            with suppress(OSError):
                send()

    thread = threading.Thread(target=flood, daemon=True)
    thread.start()
    try:
        yield
    finally:
        over.set()
        thread.join(5.0)
    assert not thread.is_alive()


def test_a_flood_of_datagrams_is_refused_and_counted(hear, udp_port) -> None:
    heard = hear(Udp('127.0.0.1', udp_port))
    heard.until(lambda: heard.link.is_up)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        with flood_of(lambda: sender.sendto(b'5.0,270', ('127.0.0.1', udp_port))):
            heard.until(lambda: sum(heard.link.refused.values()) > 100)
    assert list(heard.link.refused) == ['more than 1000 messages per second']
    assert len(heard.data) + sum(heard.link.refused.values()) == heard.link.messages


def test_a_flood_of_lines_is_refused_and_the_newest_are_read(hear, server) -> None:
    """The stream is read on, so that what follows a flood is not old."""
    heard = hear(Tcp(*server.getsockname()))
    link, _ = server.accept()
    with link:
        link.sendall(b'1.0\n' * 200_000)
        pause, begin = threading.Event(), time.monotonic()
        while not heard.data or heard.data[-1] != b'7.0':
            assert time.monotonic() < begin + 60.0
            link.sendall(b'7.0\n')
            pause.wait(0.02)
    admitted = 1000 * (time.monotonic() - begin + 2.0)  # a busy machine takes many seconds
    assert heard.link.refused['more than 1000 messages per second'] > 200_000 - admitted


@pytest.mark.parametrize('block', [b'\n' * 65_536, b'x' * 65_536], ids=['empty lines', 'no end'])
def test_bytes_that_are_no_lines_take_no_more_of_a_processor(
    hear, server, monkeypatch: pytest.MonkeyPatch, block: bytes
) -> None:
    """They are no messages, so that only the processor's time limits them."""
    # A fiftieth of a processor counts as a whole one: on a busy machine a thread has no more.
    counted = SimpleNamespace(
        monotonic=time.monotonic, thread_time=lambda: 50.0 * time.thread_time()
    )
    monkeypatch.setattr(pace, 'time', counted)
    rested: list[float] = []
    heard = hear(Tcp(*server.getsockname()))
    monkeypatch.setattr(heard.link, 'pause', rested.append)
    link, _ = server.accept()
    link.settimeout(0.2)
    with link, flood_of(lambda: link.sendall(block)):
        heard.until(lambda: rested)
    assert heard.data == []
