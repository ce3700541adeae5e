# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Frames of Modbus: of a line with a checksum, and of devices that answer anything."""

from contextlib import suppress
import os
import random
import struct
import threading

import pytest

from test.live.conftest import modbus  # noqa: F401
from tree_sway.live.transports import modbus as modbus_transport
from tree_sway.live.transports.modbus import checksum, Modbus


def test_the_checksum_is_that_of_published_frames() -> None:
    """Requests and an answer as they are printed in manuals of instruments."""
    assert checksum(bytes.fromhex('01030000000a')) == bytes.fromhex('c5cd')
    assert checksum(bytes.fromhex('010300000002')) == bytes.fromhex('c40b')
    assert checksum(bytes.fromhex('11 03 06 AE 41 56 52 43 40')) == bytes.fromhex('49ad')


def test_a_device_on_a_line_is_read(hear) -> None:
    pty = pytest.importorskip('pty', reason='no pseudo-terminals here')
    pytest.importorskip('serial')
    ours, theirs = pty.openpty()
    asked: list[bytes] = []

    def run() -> None:
        try:
            while request := os.read(ours, 64):
                asked.append(request)
                frame = bytes([7, 4, 4]) + struct.pack('>HH', 65, 270)
                os.write(ours, frame + checksum(frame))
        except OSError:
            return

    threading.Thread(target=run, daemon=True).start()
    place = os.ttyname(theirs)
    heard = hear(Modbus(place, 500, 2, 'input', 7, baud=9600, every=0.02))
    heard.until(lambda: len(heard.data) > 1)
    heard.link.stop()
    os.close(ours)
    os.close(theirs)
    assert heard.data[0] == struct.pack('>HH', 65, 270)
    request = bytes([7, 4]) + struct.pack('>HH', 500, 2)
    assert asked[0] == request + checksum(request)


@pytest.mark.parametrize(
    ('answer', 'said'),
    [
        (lambda request: request[:4] + b'\x00\x03\x01\x83\x02', 'no such register'),
        (lambda request: request[:4] + b'\x00\x03\x01\x83\xee', 'code 238'),
        (lambda request: request[:4] + b'\xff\xff' + bytes(70_000), 'not that of Modbus'),
        (lambda request: request[:4] + b'\x00\x05\x01\x03\x08\x00\x00', 'not that of Modbus'),
        (lambda request: b'\x77\x77' + request[2:4] + b'\x00\x03\x01\x83\x02', 'no answer'),
        (lambda request: b'HTTP/1.1 400 Bad Request', 'not that of Modbus'),
        (
            lambda request: request[:4] + b'\x00\x07\x05\x03\x04' + struct.pack('>HH', 53, 270),
            'device 5 answers in place of 1',
        ),
        (lambda request: request[:4] + b'\x00\x09\x01\x03\x06' + bytes(6), 'not that of Modbus'),
        (lambda request: request[:4] + b'\x00\x07\x01\x04\x04' + bytes(4), 'not that of Modbus'),
        (lambda request: request[:4] + b'\x00\x05\x01\x03\x04' + bytes(4), 'not that of Modbus'),
    ],
)
def test_a_wrong_answer_is_told(hear, modbus, answer, said: str) -> None:  # noqa: F811
    host, port = modbus(answer).split(':')
    heard = hear(Modbus(host, 0, 2, port=int(port)))
    heard.until(lambda: any(said in text for text in heard.said))
    assert heard.data == []


def test_late_answers_without_end_do_not_hold_a_link(hear, server) -> None:
    """A device that sends answers to other questions as fast as it can."""
    heard = hear(Modbus('127.0.0.1', 0, 2, port=server.getsockname()[1]))
    peer, _ = server.accept()
    peer.settimeout(5.0)
    late = b'\x77\x77\x00\x00\x00\x07\x01\x03\x04\x00\x00\x00\x00' * 1000

    def flood() -> None:
        try:
            while True:
                peer.sendall(late)
        except OSError:
            return

    thread = threading.Thread(target=flood, daemon=True)
    thread.start()
    heard.until(lambda: any('no answer' in text for text in heard.said))
    heard.link.stop()
    peer.close()
    thread.join(5.0)
    assert heard.data == []


@pytest.mark.parametrize('seed', range(5))
def test_no_answer_breaks_a_link(hear, modbus, monkeypatch, seed: int) -> None:  # noqa: F811
    monkeypatch.setattr(modbus_transport, '_TIMEOUT', 0.1)
    rng = random.Random(seed)

    def answer(request: bytes) -> bytes:
        noise = rng.randbytes(rng.randrange(1, 30))
        return noise if rng.random() < 0.5 else request[:4] + b'\x00\x07' + noise

    host, port = modbus(answer).split(':')
    heard = hear(Modbus(host, 0, 2, port=int(port)), longest_pause=0.02)
    heard.until(lambda: heard.link.connections > 8)
    assert all(len(data) == 4 for data in heard.data)


@pytest.mark.parametrize('pause', [0.3, 0.05])
def test_an_answer_that_drips_ends_at_its_limit(hear, server, monkeypatch, pause: float) -> None:
    """A byte now and then, for ever: the time is that of the answer, and not of its bytes."""
    monkeypatch.setattr(modbus_transport, '_TIMEOUT', 0.4)
    heard = hear(Modbus('127.0.0.1', 0, 2, port=server.getsockname()[1]))
    peer, _ = server.accept()
    over = threading.Event()

    def drip() -> None:
        with peer, suppress(OSError):
            number = peer.recv(64)[:2]
            for byte in number + b'\x00\x00\x00\x07\x01\x03\x04' + bytes(4):
                over.wait(pause)
                peer.sendall(bytes([byte]))

    thread = threading.Thread(target=drip, daemon=True)
    thread.start()
    heard.until(lambda: any('no answer' in text for text in heard.said))
    over.set()
    heard.link.stop()
    thread.join(5.0)
    assert heard.data == []


@pytest.mark.parametrize(
    ('frame', 'said'),
    [
        (b'\x02\x03\x04\x00\x35\x01\x0e', 'device 2 answers in place of 1'),
        (b'\x01\x83\x02', 'no such register'),
        (b'\x01\x03\x06' + bytes(6), 'not that of Modbus'),
        (b'\x01\x03\xff' + bytes(40), 'not that of Modbus'),
        (b'\x01\x03', 'no answer of device 1'),
    ],
)
def test_a_wrong_answer_on_a_line_is_told(hear, frame: bytes, said: str, monkeypatch) -> None:
    monkeypatch.setattr(modbus_transport, '_TIMEOUT', 0.2)
    pty = pytest.importorskip('pty', reason='no pseudo-terminals here')
    pytest.importorskip('serial')
    ours, theirs = pty.openpty()

    def run() -> None:
        with suppress(OSError):
            while os.read(ours, 64):
                os.write(ours, frame + checksum(frame))

    if len(frame) == 2:  # nothing else than these two
        monkeypatch.setattr(modbus_transport, 'checksum', lambda _frame: b'')
    threading.Thread(target=run, daemon=True).start()
    heard = hear(Modbus(os.ttyname(theirs), 0, 2, baud=9600, every=0.02))
    heard.until(lambda: any(said in text for text in heard.said))
    heard.link.stop()
    os.close(ours)
    os.close(theirs)
    assert heard.data == []


def test_a_line_that_takes_no_request_does_not_hold_the_link(hear, monkeypatch) -> None:
    """Flow control of a line may stop a writer for ever."""
    monkeypatch.setattr(modbus_transport, '_TIMEOUT', 0.1)
    serial = pytest.importorskip('serial')

    class Stuck:
        """A port whose writing waits as long as it is allowed to."""

        def __init__(self, *_place: object, write_timeout: float | None = None, **_: object):
            self._limit = 60.0 if write_timeout is None else write_timeout

        def __enter__(self):
            return self

        def __exit__(self, *_: object) -> None:
            pass

        def reset_input_buffer(self) -> None:
            pass

        def write(self, _data: bytes) -> int:
            threading.Event().wait(self._limit)
            raise serial.SerialTimeoutException('Write timeout')

    monkeypatch.setattr(serial, 'Serial', Stuck)
    heard = hear(Modbus('/dev/stuck', 0, 2, baud=9600))
    heard.until(lambda: any('Write timeout' in text for text in heard.said))
