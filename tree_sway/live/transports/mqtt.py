# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Messages of topics of an MQTT broker.

A subscriber of quality 0 meets few packets of MQTT 3.1.1 (OASIS' standard, chapter 3): these are
read here, so that the size of a message is known before memory is taken for it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
import math
import socket
import ssl
import struct
import time

from tree_sway.live.transports.link import Link
from tree_sway.live.transports.stream_lines import READ_FOR, received
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
_REFUSALS = (
    'its version of MQTT is not 3.1.1', 'client identifier', 'it is unavailable',
    'user or password', 'not authorised',
)  # fmt: skip
_REFUSED_TOPIC = 0x80


@dataclass(frozen=True)
class Mqtt:
    """A subscription to topics; ``+`` and ``#`` stand for parts of them."""

    host: str
    topics: tuple[str, ...]
    port: int = PORT
    user: str = ''
    password: str = field(default='', repr=False)
    is_encrypted: bool = False
    silence: float = math.inf

    def __str__(self) -> str:
        """Return its address."""
        scheme = 'mqtts' if self.is_encrypted else 'mqtt'
        return f'{scheme}://{self.host}:{self.port}/{",".join(self.topics)}'

    def listen(self, receiver: Link) -> None:
        """Deliver each message of the topics."""
        with self._connected() as link:
            link.sendall(_packet(_CONNECT, self._greeting()))
            packets = _Packets(lambda: receiver.refuse(f'a message of more than {_LARGEST} bytes'))
            heard = asked = time.monotonic()
            is_accepted = False
            while not receiver.is_over:
                data = received(link)
                now = time.monotonic()
                if data:
                    heard = now
                elif now - heard > (1.5 * _KEEP_ALIVE if is_accepted else _CONNECT_FOR):
                    raise ConnectionError('the broker does not answer')
                if is_accepted and now - asked > 0.5 * _KEEP_ALIVE:
                    link.sendall(_PING)
                    asked = now
                for kind, body in packets.feed(data):
                    if kind == _CONNACK:
                        _refuse(body[1] if len(body) > 1 else 0)
                        is_accepted = True
                        receiver.opened()
                        asked_for = b''.join(_text(topic) + b'\0' for topic in self.topics)
                        link.sendall(_packet(_SUBSCRIBE, b'\0\1' + asked_for))
                    elif kind == _SUBACK and _REFUSED_TOPIC in body[2:]:
                        raise ConnectionError('the broker refuses the topic: not authorised')
                    elif kind == _PUBLISH and (message := _message(body)) is not None:
                        receiver.deliver(message)
                receiver.rest()

    @contextmanager
    def _connected(self) -> Iterator[socket.socket]:
        with socket.create_connection((self.host, self.port), _CONNECT_FOR) as link:
            if not self.is_encrypted:
                link.settimeout(READ_FOR)
                yield link
                return
            context = ssl.create_default_context()
            with context.wrap_socket(link, server_hostname=self.host) as wrapped:
                wrapped.settimeout(READ_FOR)
                yield wrapped

    def _greeting(self) -> bytes:
        """Return the body of CONNECT: a clean session, and the user."""
        flags = 0x02 | (0x80 if self.user else 0) | (0x40 if self.user and self.password else 0)
        body = _text('MQTT') + struct.pack('>BBH', 4, flags, _KEEP_ALIVE) + _text('')
        if self.user:
            body += _text(self.user)
            body += _text(self.password) if self.password else b''
        return body


class _Packets:
    """Buffer of packets; one that is too large is told, and passed over as it comes."""

    def __init__(self, told: Callable[[], object]) -> None:
        self._told = told
        self._begun = b''
        self._to_skip = 0

    def feed(self, new: bytes) -> Iterator[tuple[int, bytes]]:
        """Add bytes; return the kind and body of each whole packet."""
        data = self._begun + new
        place = 0
        while True:
            skipped = min(self._to_skip, len(data) - place)
            self._to_skip -= skipped
            place += skipped
            size, start = _length(data, place)
            if size > _LARGEST:
                self._told()
                self._to_skip = start - place + size
                continue
            if not start or len(data) < start + size:
                self._begun = data[place:]
                return
            kind = data[place] >> 4
            place = start + size
            yield kind, data[start:place]


def _length(data: bytes, place: int) -> tuple[int, int]:
    """Return the length of a packet's body and where that begins; 0 and 0 if it is to come."""
    size = 0
    for n, part in enumerate(data[place + 1 : place + 5]):
        size |= (part & 0x7F) << 7 * n
        if not part & 0x80:
            return size, place + 2 + n
    if len(data) >= place + 5:
        raise ConnectionError('its answer is not MQTT')
    return 0, 0


def _refuse(code: int) -> None:
    """Raise a `ConnectionError` for the code of a broker that does not accept the connection."""
    if code:
        why = _REFUSALS[code - 1] if code <= len(_REFUSALS) else f'code {code}'
        raise ConnectionError(f'the broker refuses: {why}')


def _message(body: bytes) -> Message | None:
    """Return the message of PUBLISH with quality 0; None for a broken one."""
    size = int.from_bytes(body[:2], 'big')
    if len(body) < 2 + size:
        return None
    return Message(body[2 + size :], body[2 : 2 + size].decode('utf-8', 'replace'))


def _text(text: str) -> bytes:
    data = text.encode()
    return struct.pack('>H', len(data)) + data


def _packet(header: int, body: bytes) -> bytes:
    """Return a packet with its length, seven bits to a byte."""
    size = len(body)
    length = bytearray()
    while True:
        size, part = size >> 7, size & 0x7F
        length.append(part | (0x80 if size else 0))
        if not size:
            return bytes((header, *length)) + body
