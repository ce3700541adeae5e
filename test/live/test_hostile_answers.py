# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Servers that answer anything: a source says so, stays small and ends when it is asked to."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Iterator
from contextlib import suppress
import gzip
from hashlib import sha1
import json
import random
import socket
import threading
import tracemalloc
from typing import Any

import pytest

OK = b'HTTP/1.1 200 OK\r\n'
DEEP = b'[' * 200_000
CHUNK = b'10000\r\n' + b'x' * 65_536 + b'\r\n'
ANSWERS = {
    'endless chunks': [OK + b'Transfer-Encoding: chunked\r\n\r\n', *[CHUNK] * 400],
    'a wrong length': [OK + b'Content-Length: 99999999999\r\n\r\n{"wind_speed"'],
    'a negative length': [OK + b'Content-Length: -1\r\n\r\n'],
    'deep JSON': [OK + b'Content-Length: 200000\r\n\r\n', DEEP],
    'no numbers': [OK + b'\r\n{"wind_speed": NaN, "wind_dir": Infinity}'],
    'a huge number': [OK + b'\r\n{"wind_speed": 1' + b'0' * 5000 + b'}'],
    'headers without end': [OK, *[b'X: ' + b'y' * 8000 + b'\r\n'] * 400],
    'a redirect to a file': [b'HTTP/1.1 302 Found\r\nLocation: file:///etc/passwd\r\n\r\n'],
    'a redirect to itself': [b'HTTP/1.1 302 Found\r\nLocation: /\r\nContent-Length: 0\r\n\r\n'],
    'no gzip': [OK + b'Content-Encoding: gzip\r\nContent-Length: 9\r\n\r\n\x1f\x8b\x08zzzzzz'],
    'noise': [random.Random(1).randbytes(5000)],
    'nothing': [b''],
    'wrong types': [OK + b'\r\n[{"wind_speed": [5], "wind_dir": {"value": []}, "rawOb": 5}]'],
    'packed zeros': [OK + b'Content-Encoding: gzip\r\n\r\n', gzip.compress(bytes(1 << 28), 1)],
    'a redirect to another': [
        b'HTTP/1.1 302 Found\r\nLocation: ftp://127.0.0.1/a\r\nContent-Length: 0\r\n\r\n'
    ],
    'a header in a body': [OK + b'Content-Length: 5\r\n\r\nHTTP/1.1 200 OK\r\n\r\n{}'],
}


@pytest.fixture
def hostile() -> Iterator[Any]:
    """Answer whoever connects by blocks, and close."""
    servers: list[socket.socket] = []

    def serve(blocks: list[bytes]) -> str:
        server = socket.create_server(('127.0.0.1', 0))
        servers.append(server)

        def run() -> None:
            while True:
                try:
                    link, _ = server.accept()
                except OSError:
                    return
                with link, suppress(OSError):
                    link.settimeout(5.0)
                    link.recv(65_536)
                    for block in blocks:
                        link.sendall(block)

        threading.Thread(target=run, daemon=True).start()
        return f'127.0.0.1:{server.getsockname()[1]}'

    yield serve
    for server in servers:
        with suppress(OSError):
            server.shutdown(socket.SHUT_RDWR)
        server.close()


@pytest.mark.parametrize('scheme', ['http', 'metar', 'signalk'])
@pytest.mark.parametrize('name', ANSWERS)
def test_a_hostile_answer_is_told_and_takes_no_memory(
    hear, hostile, scheme: str, name: str, capfd
) -> None:
    place = hostile(ANSWERS[name])
    addresses = {
        'http': f'http://{place}/?every=0.2',
        'metar': f'metar:EDDB?server=http://{place}/',
        'signalk': f'signalk://{place}',
    }
    tracemalloc.start()
    try:
        heard = hear(addresses[scheme])
        heard.until(lambda: heard.wind.link.failure or heard.wind.link.messages)
        heard.wind.stop()
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert heard.wind.accepted == 0
    assert peak < 30_000_000
    assert capfd.readouterr().err == ''
    assert all(len(text) < 600 and 'Traceback' not in text for text in heard.said)


@pytest.mark.parametrize('scheme', ['http', 'metar'])
def test_an_answer_that_drips_ends_at_its_limit(
    hear, monkeypatch: pytest.MonkeyPatch, scheme: str
) -> None:
    monkeypatch.setattr('tree_sway.live.transports.http_poll._TIMEOUT', 0.5)
    server = socket.create_server(('127.0.0.1', 0))

    def drip() -> None:
        with suppress(OSError):
            link, _ = server.accept()
            link.settimeout(0.1)
            link.recv(65_536)
            link.sendall(OK + b'Content-Length: 10000\r\n\r\n')
            while True:
                with suppress(TimeoutError):
                    link.sendall(b' ')
                    if not link.recv(1):
                        return

    threading.Thread(target=drip, daemon=True).start()
    place = f'127.0.0.1:{server.getsockname()[1]}'
    address = f'http://{place}/' if scheme == 'http' else f'metar:EDDB?server=http://{place}/'
    heard = hear(address)
    heard.until(lambda: heard.wind.link.failure)
    server.close()
    assert heard.wind.link.failure == 'no answer within 0.5 s'


def frame(opcode: int, body: bytes, size: int | None = None) -> bytes:
    """Return a frame of a WebSocket, maybe with a wrong size."""
    return bytes([opcode, 127]) + (len(body) if size is None else size).to_bytes(8, 'big') + body


FRAMES = {
    'noise': random.Random(2).randbytes(5000),
    'a huge size': frame(0x81, b'x' * 1000, 1 << 62),
    'a large message': frame(0x81, b' ' * (1 << 19)),
    'a message without end': frame(0x01, b'x' * 1000) + frame(0x00, b' ' * 60_000) * 400,
    'no text': frame(0x81, b'\xff\xfe\xfd'),
    'an unknown kind': frame(0x83, b'x'),
    'signs of life without end': frame(0x89, b'x' * 100) * 5000,
    'deltas of nothing': frame(0x81, b'{"updates": [{"values": [null, 5, {"path": []}]}]}') * 50,
    'no numbers': frame(
        0x81,
        b'{"updates": [{"values": [{"path": "environment.wind.speedTrue", "value": NaN},'
        b' {"path": "environment.wind.directionTrue", "value": 1e999}]}]}',
    ),
    'an end': frame(0x88, b'\x03\xe8'),
}


@pytest.mark.parametrize('name', FRAMES)
def test_frames_of_a_hostile_server_are_counted_or_refused(hear, name: str, capfd) -> None:
    server = socket.create_server(('127.0.0.1', 0))

    def run() -> None:
        with suppress(OSError):
            while True:
                link, _ = server.accept()
                with link, suppress(OSError, IndexError):
                    link.settimeout(5.0)
                    asked = link.recv(65_536).decode()
                    key = asked.partition('Sec-WebSocket-Key: ')[2].split()[0]
                    sign = sha1(f'{key}258EAFA5-E914-47DA-95CA-C5AB0DC85B11'.encode()).digest()
                    link.sendall(
                        b'HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\n'
                        b'Connection: Upgrade\r\nSec-WebSocket-Accept: '
                        + b64encode(sign) + b'\r\n\r\n' + FRAMES[name]
                    )  # fmt: skip

    threading.Thread(target=run, daemon=True).start()
    tracemalloc.start()
    try:
        heard = hear(f'signalk://127.0.0.1:{server.getsockname()[1]}')
        heard.until(lambda: heard.wind.link.connections and heard.wind.link.failure)
        heard.wind.stop()
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
        server.close()
    assert heard.wind.accepted == 0
    assert peak < 30_000_000
    assert capfd.readouterr().err == ''
    assert all(len(text) < 600 and 'Traceback' not in text for text in heard.said)


WORDS: list[Any] = [
    None, True, -1, 0, 1e308, float('nan'), float('inf'), '', 'x' * 3000, [], {}, [[]], 10**400,
    '12', 'NaN', {'value': 5}, {'value': {'value': []}},
]  # fmt: skip


@pytest.mark.parametrize('seed', range(40))
def test_no_delta_or_report_breaks_a_reader(seed: int) -> None:
    from tree_sway.files.wind import Refusal, WindReading
    from tree_sway.live.readers.signalk import SignalKWind
    from tree_sway.live.registry import open_source
    from tree_sway.live.transports.transport import Message

    rng = random.Random(seed)
    wind = 'environment.wind.'
    read = SignalKWind()
    read_reports = open_source('metar:EDDB').read

    def any_of(*others: Any) -> Any:
        return rng.choice([*WORDS, *others])

    for _ in range(100):
        paths = (wind + 'speedTrue', wind + 'directionTrue', wind + 'angleApparent', wind)
        values = [{'path': any_of(*paths, *paths), 'value': any_of()} for _ in range(3)]
        delta = {'updates': any_of([{'values': any_of(values, values), '$source': any_of()}])}
        fields = ('icaoId', 'wspd', 'wdir', 'wgst', 'obsTime', 'rawOb')
        report = [{name: any_of() for name in fields}]
        for reader, document in ((read, delta), (read_reports, report)):
            for each in reader(Message(json.dumps(document).encode())):
                assert isinstance(each, (WindReading, Refusal))


def test_names_without_end_are_not_kept() -> None:
    from tree_sway.live.readers.named_values import WindNames
    from tree_sway.live.readers.signalk import SignalKWind
    from tree_sway.live.transports.transport import Message

    names, read = WindNames(), SignalKWind()
    tracemalloc.start()
    for k in range(300):
        name = f'environment.wind.{k}' + 'x' * 60_000
        names.read({name: 1.0, 'wind_speed': 5.0}, 'JSON')
        read(Message(json.dumps({'updates': [{'values': [{'path': name, 'value': 1}]}]}).encode()))
    taken = tracemalloc.get_traced_memory()[0]
    tracemalloc.stop()
    assert taken < 2_000_000
