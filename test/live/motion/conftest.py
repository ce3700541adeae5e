# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A phone that answers as phyphox does, and what listens to it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
import json
import math
import threading
import time
from typing import Any
from urllib.parse import parse_qsl, urlsplit

import pytest

from tree_sway.live.motion.live_motion import LiveMotion
from tree_sway.live.motion.motion_registry import open_motion

DEADLINE = 20.0
#: Inputs of experiments of phyphox, as ``/config`` has them.
ACCELERATION = {'accelerometer': ('accX', 'accY', 'accZ', 'acc_time')}
LINEAR = {'linear_acceleration': ('accX', 'accY', 'accZ', 'acc_time')}
GYROSCOPE = {'gyroscope': ('gyrX', 'gyrY', 'gyrZ', 'gyr_time')}


class Phone:
    """
    A server that answers ``/config`` and ``/get`` by the rules of phyphox' remote interface.

    Values are of 8 digits; a threshold is moved by a digit; a plain name is the last value; an
    unknown buffer is left out. ``motion`` gives the values of a source at a time [s].
    """

    def __init__(
        self, sources: Mapping[str, tuple[str, ...]], motion: Callable[[str, float], Any]
    ) -> None:
        self.sources, self.motion, self.rate = sources, motion, 100.0
        self.measuring, self.began = True, time.monotonic() - 30.0
        self.asked: list[str] = []
        self.breaks = False
        self.answer: bytes | None = None
        phone = self

        class Handler(BaseHTTPRequestHandler):
            def do_GET(self) -> None:
                phone.asked.append(self.path)
                if phone.breaks:
                    self.connection.close()
                    return
                parts = urlsplit(self.path)
                known = {'/config': phone.config, '/get': phone.get}
                if parts.path not in known:
                    self.send_error(404)
                    return
                data = phone.answer
                if data is None or parts.path == '/config':
                    data = known[parts.path](dict(parse_qsl(parts.query, True))).encode()
                self.send_response(200)
                self.send_header('Content-Type', 'application/json')
                self.end_headers()
                self.wfile.write(data)

            def log_message(self, *_: Any) -> None:
                """Stay silent."""

        self.server = ThreadingHTTPServer(('127.0.0.1', 0), Handler)
        self.server.daemon_threads = True
        threading.Thread(target=self.server.serve_forever, daemon=True).start()
        self.url = f'http://127.0.0.1:{self.server.server_address[1]}'

    def config(self, _asked: Mapping[str, str]) -> str:
        inputs = [
            {'source': source, 'outputs': [dict([pair]) for pair in zip('xyzt', names)]}  # noqa: B905
            for source, names in self.sources.items()
        ]
        return json.dumps({'title': 'Acceleration (with g)', 'inputs': inputs})

    def clear(self) -> None:
        """Begin again at zero, as after 'clear data'."""
        self.began = time.monotonic()

    def get(self, asked: Mapping[str, str]) -> str:
        now = time.monotonic() - self.began
        first = max(now - 20.0, 0.0)
        buffers = {}
        for source, names in self.sources.items():
            offset = 0.3 / self.rate if source == 'gyroscope' else 0.0
            ticks = range(math.ceil(first * self.rate), math.floor(now * self.rate) + 1)
            times = [tick / self.rate + offset for tick in ticks]
            columns = [*zip(*(self.motion(source, each) for each in times), strict=True), times]
            held = dict(zip(names, columns, strict=True))
            for name in names:
                if name in asked:
                    buffers[name] = self._buffer(held, name, asked[name])
        status = {'session': '1a2b', 'measuring': self.measuring, 'timedRun': False}
        return json.dumps({'buffer': buffers, 'status': status})

    @staticmethod
    def _buffer(held: Mapping[str, Any], name: str, value: str) -> dict[str, Any]:
        values = held[name]
        if not value:
            mode, chosen = 'single', values[-1:]
        elif value == 'full':
            mode, chosen = 'full', values
        else:
            text, _, reference = value.partition('|')
            least = float(text)
            if least:
                least += 10.0 ** math.floor(math.log10(abs(least) / 1e7))
            pairs = zip(values, held[reference or name], strict=True)
            mode, chosen = 'partial', [each for each, at in pairs if at > least]
        digits = [None if math.isnan(each) else float(f'{each:.7e}') for each in chosen]
        return {'size': 0, 'updateMode': mode, 'buffer': digits}


def swing(source: str, at: float) -> tuple[float, ...]:
    """Acceleration and rate of something that swings at 0.5 Hz."""
    phase = math.pi * at
    if source == 'gyroscope':
        return 0.1 * math.cos(phase), 0.0, 0.0
    return 0.5 * math.sin(phase), 0.1, 9.81 if source == 'accelerometer' else 0.0


@pytest.fixture
def phone() -> Iterator[Callable[..., Phone]]:
    made: list[Phone] = []

    def start(
        sources: Mapping[str, tuple[str, ...]], motion: Callable[[str, float], Any] = swing
    ) -> Phone:
        made.append(Phone(sources, motion))
        return made[-1]

    yield start
    for each in made:
        each.server.shutdown()
        each.server.server_close()


class Sensed:
    """A live sensor, what it tells, and its samples."""

    def __init__(self, address: str) -> None:
        self.said: list[str] = []
        self.samples: list[Any] = []
        self.live = LiveMotion(open_motion(address), self.said.append, heard=self.samples.append)
        self.live.start()

    def until(
        self, condition: Callable[[], Any], meanwhile: Callable[[], object] = lambda: None
    ) -> None:
        """Wait for a condition, doing something again and again."""
        end, pause = time.monotonic() + DEADLINE, threading.Event()
        while not condition():
            assert time.monotonic() < end, (self.said, self.live.problem, self.live.refused)
            meanwhile()
            pause.wait(0.01)


@pytest.fixture
def sense() -> Iterator[Callable[[str], Sensed]]:
    """Listen to an address; every thread has ended after the test."""
    made: list[Sensed] = []

    def start(address: str) -> Sensed:
        made.append(Sensed(address))
        return made[-1]

    yield start
    for each in made:
        each.live.stop()
        assert not each.live.link._thread.is_alive()
