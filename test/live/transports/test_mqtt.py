# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Packets of MQTT: of a real broker, too large, broken."""

import asyncio
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress
import random
import shutil
import socket
import struct
import subprocess
import threading
import time
import tracemalloc

import pytest

from tree_sway.live.transports.mqtt import _packet, _text, Mqtt, next_packet

HELD = b'\x20\x02\x00\x00'  # CONNACK
GRANTED = b'\x90\x03\x00\x01\x00'  # SUBACK


def publish(topic: str, payload: bytes) -> bytes:
    return _packet(0x30, _text(topic) + payload)


@pytest.fixture
def answering(server: socket.socket) -> Iterator[Callable[..., None]]:
    """Send packets to whoever connects first; the connection stays open."""
    links: list[socket.socket] = []

    def run(parts: Sequence[bytes]) -> None:
        links.append(server.accept()[0])
        with suppress(OSError):
            for part in parts:
                links[0].sendall(part)

    yield lambda *parts: threading.Thread(target=run, args=(parts,), daemon=True).start()
    for link in links:
        link.close()


def packets_of(blocks: Iterable[bytes]) -> list[tuple[int, bytes]]:
    """Read packets until the end of some blocks; each block comes when those before are read."""
    found: list[tuple[int, bytes]] = []

    async def read(reader: asyncio.StreamReader) -> None:
        with suppress(asyncio.IncompleteReadError):
            while True:
                found.append(await next_packet(reader, lambda _cause: None))

    async def run() -> None:
        reader = asyncio.StreamReader()
        reading = asyncio.create_task(read(reader))
        for block in blocks:
            reader.feed_data(block)
            await asyncio.sleep(0.0)
        reader.feed_eof()
        await reading

    asyncio.run(run())
    return found


def test_packets_are_cut_at_any_byte() -> None:
    rng = random.Random(3)
    bodies = [rng.randbytes(rng.choice([0, 3, 127, 128, 20_000])) for _ in range(50)]
    data = b''.join(_packet(0x30, body) for body in bodies)
    blocks, place = [], 0
    while place < len(data):
        size = rng.choice([1, 2, 5, 1000, 65_536])
        blocks.append(data[place : place + size])
        place += size
    assert packets_of(blocks) == [(3, body) for body in bodies]


def test_a_message_of_256_mib_takes_no_memory() -> None:
    block = bytes(65_536)

    def blocks() -> Iterator[bytes]:
        yield b'\x30\xff\xff\xff\x7f'  # 268,435,455 bytes follow
        for _ in range(4095):
            yield block
        yield block[:-1] + publish('wind', b'5')

    tracemalloc.start()
    found = packets_of(blocks())
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert found == [(3, _text('wind') + b'5')]
    assert peak < 1_000_000


def test_a_large_message_is_passed_over_and_the_next_is_read(hear, server, answering) -> None:
    big = publish('wind', bytes(300_000))
    answering(HELD, GRANTED, big, publish('wind', b'5.0'))
    heard = hear(Mqtt('127.0.0.1', ('wind',), server.getsockname()[1]))
    heard.until(lambda: heard.data == [b'5.0'])
    assert heard.messages[0].origin == 'wind'
    assert heard.link.refused == {'a message of more than 65536 bytes': 1}


@pytest.mark.parametrize(
    ('answer', 'said'),
    [
        (b'\x20\x02\x00\x05', 'not authorised'),
        (b'\x20\x02\x00\x04', 'user or password'),
        (b'\x20\x02\x00\x63', 'code 99'),
        (HELD + b'\x90\x03\x00\x01\x80', 'refuses the topic'),
        (b'\x30\xff\xff\xff\xff\x01', 'not MQTT'),
        (b'HTTP/1.1 400 Bad Request\r\n' + b' ' * 99, 'does not answer|not MQTT|closed|reset'),
    ],
)
def test_a_refusal_of_a_broker_is_told(hear, server, answering, answer: bytes, said: str) -> None:
    answering(answer)
    heard = hear(Mqtt('127.0.0.1', ('wind',), server.getsockname()[1]))
    pattern = said.split('|')
    heard.until(lambda: any(each in text for text in heard.said for each in pattern))


@pytest.mark.parametrize('seed', range(30))
def test_no_bytes_break_the_reader_of_packets(seed: int) -> None:
    rng = random.Random(seed)
    with suppress(ConnectionError):
        found = packets_of(rng.randbytes(rng.randrange(300)) for _ in range(200))
        assert all(len(body) <= 65_536 for _, body in found)


@pytest.mark.parametrize(
    ('user', 'password', 'flags', 'given'),
    [
        ('', '', 0x02, ''),
        ('tree', '', 0x82, 'tree'),
        ('tree', 'oak', 0xC2, 'tree oak'),
        ('', 'oak', 0x02, ''),  # a password without a user is none (3.1.2.9)
    ],
)
def test_user_and_password_are_given(
    hear, server, user: str, password: str, flags: int, given: str
) -> None:
    hear(Mqtt('127.0.0.1', ('wind',), server.getsockname()[1], user, password))
    expected = struct.pack('>BBH', 4, flags, 20) + b''.join(map(_text, ['', *given.split()]))
    link, _ = server.accept()
    with link:
        link.settimeout(10.0)
        asked = link.recv(200)
    assert asked == _packet(0x10, _text('MQTT') + expected)


@pytest.fixture
def mosquitto(tcp_port: int) -> Iterator[int]:
    program = shutil.which('mosquitto') or shutil.which('mosquitto', path='/usr/sbin')
    if program is None:
        pytest.skip('mosquitto is not installed')
    with subprocess.Popen(
        [program, '-p', str(tcp_port)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    ) as process:
        yield tcp_port
        process.terminate()


def test_a_real_broker_is_subscribed(hear, mosquitto: int) -> None:
    """It keeps a message for those who come later, so nobody has to wait for the subscription."""
    connect = _packet(0x10, _text('MQTT') + struct.pack('>BBH', 4, 2, 60) + _text(''))
    retained = _packet(0x31, _text('farm/wind') + b'6.5')
    end = time.monotonic() + 10.0
    while True:
        try:
            with socket.create_connection(('127.0.0.1', mosquitto), 1.0) as link:
                link.sendall(connect)
                assert link.recv(4) == HELD
                link.sendall(retained + b'\xe0\x00')
            break
        except ConnectionRefusedError:
            assert time.monotonic() < end
    heard = hear(Mqtt('127.0.0.1', ('farm/#',), mosquitto))
    heard.until(lambda: heard.data == [b'6.5'])
    assert heard.messages[0].origin == 'farm/wind'
