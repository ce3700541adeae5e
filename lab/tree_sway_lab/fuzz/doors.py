# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
What is offered to each reader of a line: good messages, damaged ones, and servers that answer so.

A `Door` has the address that its process listens to, and a function that offers messages until it
is told to end. Servers damage a message, the frame around it, or the end of the connection.
"""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import partial
from hashlib import sha1
import json
import os
import random
import socket
import struct
import threading
import time
from typing import NamedTuple

from tree_sway_lab.fuzz.mutation import drawn, mutated

_ANSWER = 0.1
_LOOK = 0.05
LINES = (
    b'$WIMWV,270.0,R,10.0,N,A*1C\r\n', b'5.3,270\n',
    b'wind_speed=19.08 km/h; wind_direction=270\n', b'  6.00 270.0   0.0 346.70  25.1\r\n',
    b'0R1,Dn=236D,Dm=270D,Dx=300D,Sn=0.0M,Sm=6.5M,Sx=9.2M\r\n', b'0+270+005.30+00\r\n',
    b'{"wind": {"wind_speed": 5.3, "wind_direction": 270}}\n',
)  # fmt: skip
JSON = (b'{"wind": {"speed": 5.3, "deg": 270}}', b'{"wind_speed": 5.3, "wind_direction": 270}')
UPLOAD = (
    b'PASSKEY=0123456789ABCDEF&stationtype=GW1000&dateutc=now&winddir=270&windspeedmph=12.3'
    b'&windgustmph=15.0',
)
DELTA = (
    b'{"context": "vessels.self", "updates": [{"$source": "a", "values": [{"path": '
    b'"environment.wind.speedTrue", "value": 5.3}, {"path": "environment.wind.directionTrue", '
    b'"value": 4.7}]}]}',
)
TEMPEST = (b'{"serial_number": "ST-1", "type": "rapid_wind", "ob": [1780000000, 5.3, 270]}',)
MOTION = (
    b'{"t": NOW, "ax": 0.1, "ay": -0.2, "az": 9.8, "gx": 0.01, "gy": 0, "gz": 0}',
    b'[{"t": NOW, "acceleration": {"x": 0.1, "y": -0.2, "z": 9.8}, "rate": [0.01, 0, 0]}]',
)
REPORT = (b'[{"icaoId": "EDDB", "wdir": 270, "wspd": 12, "rawOb": "EDDB 121200Z 27012G20KT"}]',)
_CONFIG = (
    b'{"inputs": [{"source": "accelerometer", "outputs": [{"x": "accX"}, {"y": "accY"}, '
    b'{"z": "accZ"}, {"t": "acc_time"}]}]}'
)
_BUFFERS = (
    b'{"buffer": {"accX": {"buffer": [0.1]}, "accY": {"buffer": [0.2]}, "accZ": {"buffer": [9.8]},'
    b' "acc_time": {"buffer": [NOW]}}, "status": {"measuring": true}}',
)
_TO_PAGE = (b'{"rate": 30, "ping": 1.0, "credit": 8, "wind": false}', b'{"credit": 4}',
            b'{"set": {"name": "mean_speed", "value": 6.0}}',
            b'{"pull": {"segment": 3, "to": [0.1, 0.2, 1.0], "stiffness": 100.0}}')  # fmt: skip
_GET = (
    b'GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n',
    b'GET /static/index.js HTTP/1.1\r\nHost: 127.0.0.1\r\nRange: bytes=0-9\r\n\r\n',
    b'GET /healthz HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n',
    b'POST /stream HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 2\r\n\r\n{}',
)


class Offer:
    """Good and damaged messages of a door, counted; damage ends for the last part of a trial."""

    def __init__(self, good: Sequence[bytes], seed: int) -> None:
        self.trials = 0
        """Number of messages that were offered."""
        self.is_over = self.is_good = False
        """Whether to end, and whether to offer what is good alone."""
        self.good = tuple(good)
        self.rng = random.Random(seed)

    def next(self) -> bytes:
        """Return a message: every tenth one is good."""
        self.trials += 1
        now = f'{time.monotonic():.4f}'.encode()
        content = self.rng.choice(self.good).replace(b'NOW', now)
        if self.is_good or self.rng.random() < 0.1:
            return content
        return mutated(content, drawn(self.rng))

    def damaged(self, frame: bytes, often: float = 0.1) -> bytes:
        """Return the frame of a message, which is damaged now and then."""
        if self.is_good or self.rng.random() >= often:
            return frame
        return mutated(frame, drawn(self.rng, 2))


class Door(NamedTuple):
    """Kind and address of a listener (`listener`), its good messages, and who offers them."""

    kind: str
    address: str
    good: Sequence[bytes]
    serve: Callable[[Offer], None]


def datagrams(port: int, offer: Offer) -> None:
    """Send to a port."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as link:
        while not offer.is_over:
            with suppress(OSError):
                link.sendto(offer.next()[:60_000], ('127.0.0.1', port))
            time.sleep(0.003)


def pieces(write: Callable[[bytes], object], offer: Offer) -> None:
    """Write a stream of lines, in pieces of any size."""
    while not offer.is_over:
        data = b''.join(offer.next()[:20_000] for _ in range(5))
        cut = offer.rng.randrange(len(data) + 1)
        write(data[:cut])
        write(data[cut:])
        time.sleep(0.02)


def tty(number: int, offer: Offer) -> None:
    """Write lines to a pseudo-terminal."""
    with suppress(OSError):
        pieces(partial(os.write, number), offer)


def rtu(number: int, offer: Offer) -> None:
    """Answer requests of Modbus on a line."""
    with suppress(OSError):
        while not offer.is_over:
            request = os.read(number, 64)[:8]
            frame = offer.next()
            if offer.is_good or offer.rng.random() < 0.8:
                frame += _crc(frame)
            if len(request) == 8:
                os.write(number, frame)


def serve(
    server: socket.socket, attend: Callable[[socket.socket, Offer], None], offer: Offer
) -> None:
    """Attend who connects, one after the other."""
    server.settimeout(_LOOK)
    while not offer.is_over:
        with suppress(TimeoutError), server.accept()[0] as link:
            link.settimeout(2.0)
            with suppress(OSError, struct.error, IndexError):
                attend(link, offer)


def lines(link: socket.socket, offer: Offer) -> None:
    """Be a server of lines, that closes now and then."""
    for _ in range(200):
        link.sendall(offer.next()[:20_000])
        time.sleep(0.003)
        if offer.is_over or (not offer.is_good and offer.rng.random() < 0.01):
            return


def modbus(link: socket.socket, offer: Offer) -> None:
    """Answer requests of Modbus over TCP; an answer's length is right or damaged."""
    while not offer.is_over and (request := link.recv(64)):
        body = offer.next()
        head = request[:4] + struct.pack('>H', len(body) & 0xFFFF)
        link.sendall(offer.damaged(head, 0.2) + body)


def broker(link: socket.socket, offer: Offer) -> None:
    """Be a broker of MQTT, that closes now and then, as a damaged length hides the rest."""
    link.recv(4096)
    link.sendall(offer.damaged(b'\x20\x02\x00\x00'))
    link.recv(4096)
    link.sendall(offer.damaged(b'\x90\x03\x00\x01\x00'))
    for _ in range(500):
        body = b'\x00\x01w' + offer.next()[:16_000]
        size = bytes([len(body) & 0x7F | 0x80, len(body) >> 7])
        link.sendall(offer.damaged(b'\x30' + size + body, 0.02))
        time.sleep(0.003)
        if offer.is_over:
            return


def http(link: socket.socket, offer: Offer) -> None:
    """Answer a request of HTTP, whatever it asks for."""
    link.recv(65_536)
    body = offer.next()
    head = b'HTTP/1.1 200 OK\r\nContent-Type: application/json\r\n'
    link.sendall(offer.damaged(head, 0.3) + f'Content-Length: {len(body)}\r\n\r\n'.encode() + body)


def phone(link: socket.socket, offer: Offer) -> None:
    """Be a phone with phyphox: its configuration, mostly whole, and its buffers."""
    asked = link.recv(65_536)
    if b'/config' in asked:
        body = offer.damaged(_CONFIG, 0.02)
        offer.trials += 1
    else:
        body = offer.next()
    link.sendall(b'HTTP/1.1 200 OK\r\nContent-Length: %d\r\n\r\n' % len(body) + body)


def websocket(link: socket.socket, offer: Offer, *, opcode: int = 0x81) -> None:
    """Be a server of a WebSocket."""
    asked = link.recv(65_536).decode('latin-1')
    key = asked.partition('Sec-WebSocket-Key: ')[2].split()[0]
    sign = sha1(f'{key}258EAFA5-E914-47DA-95CA-C5AB0DC85B11'.encode()).digest()
    answer = b'HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n'
    link.sendall(offer.damaged(answer, 0.02) + b'Sec-WebSocket-Accept: ' + b64encode(sign))
    link.sendall(b'\r\n\r\n')
    for _ in range(100):
        link.sendall(offer.damaged(_frame(opcode, offer.next()), 0.02))
        time.sleep(0.005)
        if offer.is_over:
            return


def stream(first: bytes, link: socket.socket, offer: Offer) -> None:
    """Be a server of the stream: its description, then descriptions, frames and texts."""
    offer.good = (first, *offer.good[1:])
    websocket(link, offer, opcode=0x82)


def upload(port: int, offer: Offer) -> None:
    """Send a station's form to a port."""
    while not offer.is_over:
        form = offer.next()
        head = b'POST /data/report/ HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n'
        _ask(port, offer.damaged(head) + b'Content-Length: %d\r\n\r\n' % len(form) + form)


def visits(port: int, offer: Offer) -> None:
    """Ask a page for anything."""
    while not offer.is_over:
        offer.good = _GET
        _ask(port, offer.next())


def viewer(port: int, offer: Offer) -> None:
    """Be a page that is connected to the stream, and says anything."""
    hello = (b'GET /stream HTTP/1.1\r\nHost: 127.0.0.1:%d\r\nUpgrade: websocket\r\nConnection: '
             b'Upgrade\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: '
             b'dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n' % port)  # fmt: skip
    while not offer.is_over:
        offer.good = _TO_PAGE
        with suppress(OSError), socket.create_connection(('127.0.0.1', port), 2.0) as link:
            link.sendall(hello)
            for _ in range(20):
                link.sendall(offer.damaged(_masked(offer.next()), 0.05))
                link.settimeout(0.02)
                with suppress(TimeoutError):
                    if not link.recv(65_536):
                        break


def _ask(port: int, request: bytes) -> None:
    with suppress(OSError), socket.create_connection(('127.0.0.1', port), 2.0) as link:
        link.sendall(request)
        link.settimeout(_ANSWER)
        while link.recv(65_536):
            pass


def _frame(opcode: int, body: bytes) -> bytes:
    """Return a frame of a WebSocket, as a server sends it."""
    if len(body) < 126:
        return bytes([opcode, len(body)]) + body
    if len(body) < 65_536:
        return bytes([opcode, 126]) + struct.pack('>H', len(body)) + body
    return bytes([opcode, 127]) + struct.pack('>Q', len(body)) + body


def _masked(body: bytes) -> bytes:
    """Return a frame of text, as a client sends it."""
    mask = b'\x01\x02\x03\x04'
    body = bytes(each ^ mask[k % 4] for k, each in enumerate(body[:10_000]))
    frame = bytearray(_frame(0x81, mask + body))
    # The length is that without the mask.
    whole = _frame(0x81, body)
    start = len(whole) - len(body)
    frame[:start] = whole[:start]
    frame[1] |= 0x80
    return bytes(frame)


def _crc(frame: bytes) -> bytes:
    """Return the checksum of Modbus on a line."""
    value = 0xFFFF
    for bit in (byte >> k & 1 for byte in frame for k in range(8)):
        value = value >> 1 ^ 0xA001 * ((value ^ bit) & 1)
    return value.to_bytes(2, 'little')


def _words(*values: int) -> bytes:
    return struct.pack(f'>{len(values)}h', *values)


def doors(description: bytes, frames: Sequence[bytes], page: int) -> dict[str, Door]:
    """
    Make every door, with ports of this machine.

    Parameters
    ----------
    description, frames
        What a server of the stream sends.
    page
        Port of a page that is served already; its doors have no process of their own.

    """
    made = dict[str, Door]()

    def server_of(name: str, kind: str, address: str, good: Sequence[bytes],
                  attend: Callable[[socket.socket, Offer], None]) -> None:  # fmt: skip
        server = socket.create_server(('127.0.0.1', 0))
        place = f'127.0.0.1:{server.getsockname()[1]}'
        made[name] = Door(kind, address.format(place), good, partial(serve, server, attend))

    def sends_to(name: str, kind: str, address: str, good: Sequence[bytes],
                 send: Callable[[int, Offer], None]) -> None:  # fmt: skip
        with socket.create_server(('127.0.0.1', 0)) as trial:
            port = int(trial.getsockname()[1])
        made[name] = Door(kind, address.format(port), good, partial(send, port))

    def line_of(name: str, address: str, good: Sequence[bytes],
                send: Callable[[int, Offer], None]) -> None:  # fmt: skip
        ours, theirs = os.openpty()
        made[name] = Door('wind', address.format(os.ttyname(theirs)), good, partial(send, ours))

    registers = b'\x03\x04' + _words(53, 270)
    sends_to('UDP', 'wind', 'udp://127.0.0.1:{}', LINES, datagrams)
    server_of('TCP', 'wind', 'tcp://{}', LINES, lines)
    line_of('serial', 'serial:{}:9600', LINES, tty)
    server_of('MQTT', 'wind', 'mqtt://{}/w', JSON, broker)
    server_of('HTTP', 'wind', 'http://{}/?every=0.2', JSON, http)
    server_of('METAR', 'wind', 'metar:EDDB?every=0.2&server=http://{}/', REPORT, http)
    sends_to('station', 'wind', 'ecowitt:{}', UPLOAD, upload)
    server_of('Signal K', 'wind', 'signalk://{}', DELTA, websocket)
    sends_to('Tempest', 'wind', 'tempest?port={}', TEMPEST, datagrams)
    modbus_good = (b'\x01' + registers, b'\x01\x83\x02')
    server_of('Modbus TCP', 'wind', 'modbus:{}?direction=1&every=0.02', modbus_good, modbus)
    line_of('Modbus RTU', 'modbus:{}:9600?direction=1&every=0.02', modbus_good, rtu)
    sends_to('motion, UDP', 'motion', 'udp://127.0.0.1:{}', MOTION, datagrams)
    server_of('motion, MQTT', 'motion', 'mqtt://{}/w', MOTION, broker)
    server_of('phyphox', 'motion', 'http://{}?every=0.02', _BUFFERS, phone)
    texts = (b'{"status": {"rate": 60.0}}', json.dumps({'pong': 1.0}).encode())
    server_of('stream', 'stream', 'http://{}/', (description, *frames, *texts),
              partial(stream, description))  # fmt: skip
    made['page, HTTP'] = Door('', '', _GET, partial(visits, page))
    made['page, WebSocket'] = Door('', '', _TO_PAGE, partial(viewer, page))
    return made


def offering(door: Door, seed: int) -> tuple[Offer, threading.Thread]:
    """Start to offer messages to a door."""
    offer = Offer(door.good, seed)
    thread = threading.Thread(target=door.serve, args=(offer,), daemon=True)
    thread.start()
    return offer, thread
