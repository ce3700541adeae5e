# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Frames of Modbus: of a line with a checksum, and of devices that answer anything."""

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
