# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Messages of topics of an MQTT broker.

A subscriber of quality 0 meets few packets of MQTT 3.1.1 (OASIS' standard, chapter 3): these are
read here, so that the size of a message is known before memory is taken for it. Eclipse Paho keeps
a message of any size up to the 256 MiB of the protocol, and those of quality 2 without limit.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from dataclasses import dataclass, field
import ssl
import struct

from tree_sway.live.transports.link import Link
from tree_sway.live.transports.loop_transport import LoopTransport
from tree_sway.live.transports.transport import Message

PORT, TLS_PORT = 1883, 8883
"""Ports of MQTT without and with TLS."""
_LARGEST = 65_536
"""Largest packet that is read [bytes]; larger ones are passed over."""
_CONNECT_FOR = 5.0
"""Longest wait for a connection, and for its being accepted [s]."""
_KEEP_ALIVE = 20
"""Interval [s] in which a broker without messages is asked for a sign of life."""
_CONNACK, _PUBLISH, _SUBACK = 2, 3, 9
_CONNECT, _SUBSCRIBE, _PING = 0x10, 0x82, b'\xc0\x00'
_FLAGS = (0x02, 0x82, 0xC2)
"""Flags of a clean session without a user, with one, and with a password too."""
_REFUSALS = (
    'its version of MQTT is not 3.1.1', 'client identifier', 'it is unavailable',
    'user or password', 'not authorised',
)  # fmt: skip
_REFUSED_TOPIC = 0x80


@dataclass(frozen=True)
class Mqtt(LoopTransport):
    """A subscription to topics; ``+`` and ``#`` stand for parts of them."""

    host: str
    topics: tuple[str, ...]
    port: int = PORT
    user: str = ''
    password: str = field(default='', repr=False)
    is_encrypted: bool = False

    def __str__(self) -> str:
        """Return its address."""
        scheme = 'mqtts' if self.is_encrypted else 'mqtt'
        return f'{scheme}://{self.host}:{self.port}/{",".join(self.topics)}'

    async def _work(self, receiver: Link) -> None:
        tls = ssl.create_default_context() if self.is_encrypted else None
        opening = asyncio.open_connection(self.host, self.port, ssl=tls)
        try:
            reader, writer = await asyncio.wait_for(opening, _CONNECT_FOR)
            asking = asyncio.create_task(_ask_for_life(writer))
            try:
                await self._subscribe(reader, writer, receiver)
                await _deliver(reader, receiver)
            finally:
                asking.cancel()
                writer.transport.abort()
        except asyncio.TimeoutError:
            raise ConnectionError('the broker does not answer') from None
        except asyncio.IncompleteReadError:
            raise ConnectionError('closed by the other side') from None

    async def _subscribe(
        self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter, receiver: Link
    ) -> None:
        """Begin a clean session, and ask for the topics."""
        given = [each for each in (self.user, self.password if self.user else '') if each]
        head = _text('MQTT') + struct.pack('>BBH', 4, _FLAGS[len(given)], _KEEP_ALIVE)
        writer.write(_packet(_CONNECT, head + b''.join(map(_text, ['', *given]))))
        kind, body = await asyncio.wait_for(next_packet(reader, receiver.refuse), _CONNECT_FOR)
        if kind != _CONNACK or len(body) != 2:
            raise ConnectionError('its answer is not MQTT')
        if code := body[1]:
            why = _REFUSALS[code - 1] if code <= len(_REFUSALS) else f'code {code}'
            raise ConnectionError(f'the broker refuses: {why}')
        receiver.opened()
        topics = b''.join(_text(topic) + b'\0' for topic in self.topics)
        writer.write(_packet(_SUBSCRIBE, b'\0\1' + topics))


async def _ask_for_life(writer: asyncio.StreamWriter) -> None:
    while True:
        await asyncio.sleep(0.5 * _KEEP_ALIVE)
        writer.write(_PING)


async def _deliver(reader: asyncio.StreamReader, receiver: Link) -> None:
    """Deliver messages of quality 0, without end."""
    while True:
        packet = next_packet(reader, receiver.refuse)
        kind, body = await asyncio.wait_for(packet, 1.5 * _KEEP_ALIVE)
        if kind == _SUBACK and _REFUSED_TOPIC in body[2:]:
            raise ConnectionError('the broker refuses the topic: not authorised')
        begin = 2 + int.from_bytes(body[:2], 'big')
        if kind == _PUBLISH and begin <= len(body):
            receiver.deliver(Message(body[begin:], body[2:begin].decode('utf-8', 'replace')))


async def next_packet(
    reader: asyncio.StreamReader, refuse: Callable[[str], object]
) -> tuple[int, bytes]:
    """Return the kind and body of a packet; one that is too large is passed over as it comes."""
    while True:
        kind = (await reader.readexactly(1))[0] >> 4
        size = 0
        for place in range(4):
            part = (await reader.readexactly(1))[0]
            size |= (part & 0x7F) << 7 * place
            if part < 0x80:
                break
        else:
            raise ConnectionError('its answer is not MQTT')
        if size <= _LARGEST:
            return kind, await reader.readexactly(size)
        refuse(f'a message of more than {_LARGEST} bytes')
        while size:
            size -= len(await reader.readexactly(min(size, _LARGEST)))


def _text(text: str) -> bytes:
    data = text.encode()
    return struct.pack('>H', len(data)) + data


def _packet(header: int, body: bytes) -> bytes:
    """Return a packet with its length, seven bits to a byte."""
    size = len(body)
    length = bytearray()
    while size >= 0x80:
        length.append(size & 0x7F | 0x80)
        size >>= 7
    return bytes((header, *length, size)) + body
