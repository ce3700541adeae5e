# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A page without ROS: four clients, an anemometer and two motion sensors, for hours."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from contextlib import ExitStack
import json
import math
import socket
import subprocess
import sys
import threading
import time

import numpy as np

from tree_sway.commands import Ending
from tree_sway.errors import TransportError
from tree_sway.files.trees import open_tree
from tree_sway.stream import StreamClient
from tree_sway_lab.soak.health import check, has_grown, Health, health, line_of, period_of

CLIENTS = 4
HEIGHTS = 0.3, 0.6
"""Places of the motion sensors on the stem, as shares of its height."""
_WIND_RATE, _MOTION_RATE = 20.0, 50.0
_START = 120.0


def soak_page(arguments: argparse.Namespace, seconds: float, rate: float) -> int:
    """Run a page with its instruments and clients, then report what it took."""
    with Ending() as ending, PageSoak(arguments.tree, rate) as page:
        page.wait(ending)
        seen, slowest = list[Health](), list[float]()
        begin, period = time.monotonic(), period_of(seconds)
        while (since := time.monotonic() - begin) < seconds and not ending.is_asked:
            check('page', page.process)
            seen.append(health(since, page.process.pid))
            time.sleep(min(period, seconds - since))
            slowest.append(min(page.rates()))
            print(line_of({'page': seen}, slowest[-1]), flush=True)
        check('page', page.process)
        told = ', '.join(f'{least:.1f}' for least in np.percentile(slowest, (0, 5, 50)))
        print(f'slowest  of {CLIENTS} clients: {told} Hz (least, 5 %, median) of {rate:g} wanted')
        print(f'sent     {page.sent} samples; {page.unreadable} unreadable messages')
        print(f'status   {page.status}')
        is_larger = has_grown({'page': seen}, arguments.slope)
    return int(is_larger or page.unreadable > 0)


class PageSoak:
    """
    The process of the page, what is sent to it, and its clients.

    Parameters
    ----------
    tree
        The tree that sways.
    rate
        Frames that each client requests [Hz].

    """

    def __init__(self, tree: str, rate: float) -> None:
        page, wind, *motion = _free_ports(2 + len(HEIGHTS))
        height = float(open_tree(tree).tree.end[:, 2].max())
        command = [sys.executable, '-m', 'tree_sway', 'show', tree, '-q']
        command += ['--port', f'{page}', '--sensor', f'udp://127.0.0.1:{wind}']
        for share, port in zip(HEIGHTS, motion, strict=True):
            command += ['--motion', f'udp://127.0.0.1:{port}', '--at', f'{share * height:.2f}']
        self.process = subprocess.Popen(
            command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
        )
        self.sent = 0
        """Number of samples of all instruments."""
        self._ports = wind, *motion
        self._over = threading.Event()
        self._sender = threading.Thread(target=self._send, daemon=True)
        self._stack = ExitStack()
        self._clients = [StreamClient(f'http://127.0.0.1:{page}/', rate=rate)
                         for _ in range(CLIENTS)]  # fmt: skip
        self._counts = [0] * CLIENTS
        self._since = time.monotonic()

    def __enter__(self) -> PageSoak:
        self._sender.start()
        for client in self._clients:
            self._stack.enter_context(client)
        return self

    def __exit__(self, *_: object) -> None:
        self._stack.close()
        self._over.set()
        self._sender.join()
        self.process.terminate()
        try:
            self.process.wait(20.0)
        except subprocess.TimeoutExpired:
            self.process.kill()

    def wait(self, ending: Ending) -> None:
        """Wait until every client has frames; a `TransportError` if they do not come."""
        deadline = time.monotonic() + _START
        while not all(client.has_frames(0.1) for client in self._clients):
            if self.process.poll() is not None or time.monotonic() > deadline:
                raise TransportError('the page sends no frames')
            if ending.is_asked:
                return
        self.rates()

    def rates(self) -> list[float]:
        """Frames per second of each client since the last call [Hz]."""
        now = time.monotonic()
        counts = [client.received for client in self._clients]
        passed, self._since = now - self._since, now
        rates = [(new - old) / passed for new, old in zip(counts, self._counts, strict=True)]
        self._counts = counts
        return rates

    @property
    def unreadable(self) -> int:
        """Number of messages that a client could not read."""
        return sum(client.unreadable for client in self._clients)

    @property
    def status(self) -> dict[str, object]:
        """The newest status of the page."""
        return self._clients[0].status

    def _send(self) -> None:
        """Send what the instruments tell, by the clock, until the end."""
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as link:
            for tick in _ticks(_MOTION_RATE, self._over):
                at = tick / _MOTION_RATE
                lines = [(port, _motion(at)) for port in self._ports[1:]]
                if tick % round(_MOTION_RATE / _WIND_RATE) == 0:
                    lines.append((self._ports[0], _wind(at)))
                for port, line in lines:
                    link.sendto(line, ('127.0.0.1', port))
                    self.sent += 1


def _ticks(rate: float, over: threading.Event) -> Iterator[int]:
    begin = time.monotonic()
    tick = 0
    while not over.wait(max(0.0, begin + tick / rate - time.monotonic())):
        yield tick
        tick += 1


def _wind(at: float) -> bytes:
    speed = 6.0 + 2.0 * math.sin(0.3 * at) + math.sin(1.7 * at)
    return f'{speed:.2f},{270.0 + 20.0 * math.sin(0.1 * at):.1f}\n'.encode()


def _motion(at: float) -> bytes:
    sway = math.sin(math.tau * 0.4 * at)
    sample = {'t': at, 'ax': 0.3 * sway, 'ay': 0.1 * sway, 'az': 9.81, 'gx': 0.02 * sway}
    return json.dumps({**sample, 'gy': 0.05 * sway, 'gz': 0.0}).encode()


def _free_ports(count: int) -> list[int]:
    with ExitStack() as stack:
        trials = [stack.enter_context(socket.socket()) for _ in range(count)]
        for trial in trials:
            trial.bind(('127.0.0.1', 0))
        return [int(trial.getsockname()[1]) for trial in trials]
