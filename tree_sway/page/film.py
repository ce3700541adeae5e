# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Pictures of a scene, drawn by the page in a browser without a screen.

The browser opens the scene as one file (`page_of_state`) from this machine; ``static/film.js``
then requests the states one by one and sends the pictures back.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
import json
import os
from queue import Empty, Queue
import shutil
import subprocess
from tempfile import TemporaryDirectory
from threading import Thread
import time
from urllib.parse import urlencode

from tree_sway.core.scene import Simulator
from tree_sway.errors import TransportError
from tree_sway.page.one_file import page_of_state
from tree_sway.stream import SceneState

_NAMES = ('chromium', 'chromium-browser', 'google-chrome', 'google-chrome-stable')
_FLAGS = (
    '--headless', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--mute-audio',
    '--force-device-scale-factor=1', '--no-first-run', '--disable-background-networking',
)  # fmt: skip
_WIDTH = 1.6
"""Width of a picture over its height."""
_PATIENCE = 120.0
"""Time without a picture after which the browser is stopped [s]."""
_LOOK = 0.5
"""Interval at which it is looked whether the browser still runs [s]."""


def browser() -> str | None:
    """Return the path of a Chromium or Chrome; None if none is installed."""
    return next(filter(None, map(shutil.which, _NAMES)), None)


def page_pictures(
    simulator: Simulator, frames: Iterable[object], rate: float, pixels: int, n_leaves: int
) -> Iterator[bytes]:
    """
    Yield a PNG of a simulator's state at each frame.

    Parameters
    ----------
    simulator
        A tree or a scene on a number of coordinates, at rest.
    frames
        Iterator that advances the simulator from one frame to the next.
    rate
        Frames per second [Hz].
    pixels
        Height of the pictures in [px].
    n_leaves
        Number of clusters of leaves, as in `SceneState`.

    Raises
    ------
    ParameterError
        A tree on a model that is not a number of coordinates.
    TransportError
        No browser, or one that draws nothing.

    """
    scene = SceneState(simulator, n_leaves)
    page = page_of_state(scene, 'film.js')
    states = Queue[bytes]()
    pictures = Queue[bytes]()

    class Handler(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            self._answer(page.encode(), 'text/html')

        def do_POST(self) -> None:
            # A page of another origin must not put pictures into the film.
            if self.headers['Origin'] != f'http://127.0.0.1:{self.connection.getsockname()[1]}':
                self.send_error(403)
                return
            if size := int(self.headers['Content-Length'] or 0):
                pictures.put(self.rfile.read(size))
            self._answer(states.get(), 'application/json')

        def _answer(self, body: bytes, kind: str) -> None:
            self.send_response(200)
            self.send_header('Content-Type', f'{kind}; charset=utf-8')
            self.end_headers()
            self.wfile.write(body)

        def log_message(self, *_: object) -> None:
            """Log nothing."""

    with (
        ThreadingHTTPServer(('127.0.0.1', 0), Handler) as server,
        TemporaryDirectory(ignore_cleanup_errors=True) as profile,
    ):
        Thread(target=server.serve_forever, daemon=True).start()
        size = {'width': f'{2 * round(0.5 * _WIDTH * pixels)}px', 'height': f'{pixels}px'}
        address = f'http://127.0.0.1:{server.server_port}/?quality=full&{urlencode(size)}'
        sandbox = ['--no-sandbox'] if getattr(os, 'geteuid', lambda: 1)() == 0 else []
        words = [str(browser()), *_FLAGS, *sandbox, f'--user-data-dir={profile}', address]
        process = subprocess.Popen(words, stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
        try:
            for number, _ in enumerate(frames):
                wind = simulator.wind.tolist()
                coordinates = scene.coordinates().tolist()
                state = {'time': number / rate, 'wind': wind, 'coordinates': coordinates}
                states.put(json.dumps(state).encode())
                yield _next_picture(pictures, process, words[0])
        finally:
            process.kill()
            process.wait()
            server.shutdown()


def _next_picture(pictures: Queue[bytes], process: subprocess.Popen[bytes], where: str) -> bytes:
    """Wait for a picture; a `TransportError` reports a browser that ended or draws nothing."""
    end = time.monotonic() + _PATIENCE
    while time.monotonic() < end:
        has_ended = process.poll() is not None
        try:
            return pictures.get(timeout=_LOOK)
        except Empty:
            if has_ended:
                what = f'the browser ended with status {process.returncode}'
                cure = 'start it by itself to see why'
                raise TransportError(what, where=where, cure=cure) from None
    what = f'the browser drew nothing for {_PATIENCE:.0f} s'
    raise TransportError(what, where=where, cure='give fewer --pixels')
