# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
From an anemometer's sample to the frame that shows it, through all nodes and a page's client.

The wind jumps twice a second. A jump is shown by the first frame whose mean wind has gone a tenth
of its way; its time counts from the stamp of the first sample after it. Samples come at a rate
that is no part of that of the frames, so that they fall anywhere between two. Nodes `wind`,
`solver` and `viewer` are processes of their own, the anemometer and the clients are one more, all
on one clock.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
import contextlib
from functools import partial
from itertools import pairwise
import json
import os
import secrets
import select
import socket
import subprocess
import sys
import tempfile
import threading
import time
from typing import IO

import numpy as np

from tree_sway.commands import waiting
from tree_sway.core.arrays import Floats
from tree_sway.errors import TransportError
from tree_sway.stream import Frame, StreamClient
from tree_sway_lab.bench.long_line import carry, HERE, join_line, THERE
from tree_sway_lab.bench.measured import Measured
from tree_sway_lab.bench.stream import isolated

_RATE, _PER_MARK = 19.3, 10
_LOW, _HIGH, _SHOWN = 5.0, 8.0, 0.1
LOSSES = (0.0, 0.01, 0.03)
"""Shares of packets that are lost, either way."""

WAYS = ('by state', 'by wind')
_START, _PORT = 120.0, 8765
_FRAMES = 60.0


class Seen:
    """When a client had each frame, and when its playout shows it, and the frame's wind."""

    def __init__(self, url: str, *, by_wind: bool) -> None:
        self._rows: list[tuple[float, float, float]] = []
        self.client = StreamClient(url, rate=_FRAMES, by_wind=by_wind, on_frame=self._take)

    def _take(self, frame: Frame, arrival: float) -> None:
        playout = self.client.playout
        due = 1e-9 * frame.stamp + playout.clock.value + playout.delay
        self._rows.append((arrival, max(arrival, due), float(frame.wind[0])))

    @property
    def rows(self) -> list[tuple[float, float, float]]:
        """Arrival and showing [s] and wind [m/s] of each frame."""
        return list(self._rows)

    def late(self, marks: list[tuple[float, float]]) -> Floats:
        """Return times from marks (time [s], wind [m/s]) as `lateness`."""
        return lateness(marks, np.array(self._rows).reshape(-1, 3))


def lateness(marks: list[tuple[float, float]], rows: Floats) -> Floats:
    """
    Find the first frame that shows each mark, but for the last.

    Parameters
    ----------
    marks
        Time [s] and wind [m/s] of the first sample after each jump.
    rows
        Arrival and showing [s] and wind [m/s] of each frame, (f, 3).

    Returns
    -------
    Floats
        From a mark to arrival and to showing [s], (k, 2); a mark that none shows before the next
        is left out.

    """
    found = []
    for (begin, wind), (end, before) in pairwise(marks):
        is_past = (rows[:, 2] - before) / (wind - before) > _SHOWN
        first = np.flatnonzero((rows[:, 0] > begin) & (rows[:, 0] < end) & is_past)
        if len(first):
            found.append(rows[first[0], :2] - begin)
    return np.array(found).reshape(-1, 2)


def time_vane_to_leaf(tree: str = 'benjamina', seconds: float = 20.0) -> list[Measured]:
    """
    Send jumps of the wind through the chain of nodes, and wait for them in two clients.

    Returns p50, p95 and p99 in [ms] by state and by wind alone, at arrival and as shown after the
    playout of the page. Raises a `TransportError` if no frame comes.
    """
    environment = isolated(os.getpid() + 2)
    os.environ.update(environment)
    with socket.create_server(('127.0.0.1', 0)) as free:
        port = free.getsockname()[1]
    given = {
        'wind': ['max_rate:=1000.0'],
        'solver': [f'tree:={tree}', f'rate:={_FRAMES}', f'state_rate:={_FRAMES}'],
        'viewer': [f'port:={port}'],
    }
    url = f'http://127.0.0.1:{port}/'
    seen = {way: Seen(url, by_wind=way == 'by wind') for way in WAYS}
    with (
        waiting('wind, solver and viewer in processes of their own'),
        _started(given, environment),
        contextlib.ExitStack() as stack,
    ):
        clients = [stack.enter_context(each.client) for each in seen.values()]
        marks = _blow(lambda: all(each.playout.received for each in clients), seconds)
    rows = []
    for way, each in seen.items():
        late = 1e3 * each.late(marks)
        if len(late) == 0:
            raise TransportError(
                'no jump of the wind arrived', where=way, cure='ask for more --seconds'
            )
        for what, times in zip(('', ', shown'), late.T, strict=True):
            rows += [
                Measured(f'vane to leaf {way}{what}, p{share}', value, 'ms')
                for share, value in _shares(times)
            ]
    return rows


def time_long_line(tree: str = 'benjamina', seconds: float = 20.0) -> list[Measured]:
    """
    Do the same over a line of 80 ms there and back that loses packets, for each of `LOSSES`.

    At arrival and as shown, by state and by wind alone. Needs root; else it returns nothing.
    """
    if os.geteuid() != 0:
        return []
    environment = isolated(os.getpid() + 3)
    os.environ.update(environment)
    ends = [socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET) for _ in range(2)]
    join_line(ends[0][1].detach(), HERE)
    outer, inner = [end for end, _ in ends], ends[1][1]
    token = secrets.token_hex(16)
    given = {
        'wind': ['max_rate:=1000.0'],
        'solver': [f'tree:={tree}', f'rate:={_FRAMES}', f'state_rate:={_FRAMES}'],
        'viewer': [f'port:={_PORT}', f'address:={HERE}'],
    }
    program = f'from {__name__} import follow; follow({inner.fileno()}, {_url(token)!r})'
    command = ['unshare', '-rn', sys.executable, '-c', program]
    phases = []
    with tempfile.NamedTemporaryFile('w') as secret:
        secret.write(token)
        secret.flush()
        given['viewer'].append(f'token_file:={secret.name}')
        with (
            waiting('wind, solver and viewer, and clients at the end of a long line'),
            _started(given, environment),
            subprocess.Popen(
                command, pass_fds=[inner.fileno()], stdin=subprocess.PIPE, stdout=subprocess.PIPE
            ) as child,
        ):
            assert child.stdout is not None
            ready: Callable[[], bool] = partial(_has_said, child.stdout)
            for loss in LOSSES:
                ended = threading.Event()
                line = threading.Thread(target=carry, args=(outer, 0.04, loss, ended), daemon=True)
                line.start()
                phases.append(_blow(ready, seconds))
                ready = _always
                ended.set()
                line.join()
            said, _ = child.communicate(b'')
    rows = json.loads(said.splitlines()[-1])
    return [
        Measured(f'vane to leaf {way}, 80 ms, {100 * loss:g} % lost{what}, p{share}', value, 'ms')
        for loss, marks in zip(LOSSES, phases, strict=True)
        for way, seen in rows.items()
        for what, times in zip(
            ('', ', shown'), 1e3 * lateness(marks, np.array(seen)).T, strict=True
        )
        for share, value in _shares(times)
    ]


def follow(descriptor: int, url: str) -> None:
    """Follow a page from the far end of a line until the input ends; prints the rows as JSON."""
    join_line(descriptor, THERE)
    seen = {way: Seen(url, by_wind=way == 'by wind') for way in WAYS}
    with contextlib.ExitStack() as stack:
        for each in seen.values():
            stack.enter_context(each.client).wait(_START)
        print('ready', flush=True)
        sys.stdin.read()
    print(json.dumps({way: each.rows for way, each in seen.items()}), flush=True)


def _url(token: str) -> str:
    return f'http://{HERE}:{_PORT}/?token={token}'


def _has_said(pipe: IO[bytes]) -> bool:
    return bool(select.select([pipe], [], [], 0.0)[0])


def _always() -> bool:
    return True


def _shares(times: Floats) -> list[tuple[int, float]]:
    return [(share, float(np.percentile(times, share))) for share in (50, 95, 99)]


@contextlib.contextmanager
def _started(given: dict[str, list[str]], environment: dict[str, str]) -> Iterator[None]:
    """Run nodes with their parameters, each in a process."""
    children = []
    try:
        for name, parameters in given.items():
            program = f'from tree_sway_ros.nodes.executables import {name} as run; run()'
            pairs = [part for each in parameters for part in ('-p', each)]
            command = [sys.executable, '-c', program, '--ros-args', *pairs]
            children.append(subprocess.Popen(command, env=environment, stderr=subprocess.DEVNULL))
        yield
    finally:
        for child in children:
            child.terminate()
        for child in children:
            child.wait()


def _blow(is_ready: Callable[[], bool], seconds: float) -> list[tuple[float, float]]:
    """Publish samples until ready clients have followed for a time [s]; returns the marks."""
    from geometry_msgs.msg import Vector3Stamped
    import rclpy
    from rclpy.executors import SingleThreadedExecutor
    from rclpy.qos import QoSProfile

    marks: list[tuple[float, float]] = []
    count = 0

    def blow() -> None:
        nonlocal count
        message, now = Vector3Stamped(), time.time_ns()
        message.header.stamp.sec, message.header.stamp.nanosec = divmod(now, 1_000_000_000)
        message.header.frame_id = 'map'
        message.vector.x = _HIGH if count // _PER_MARK % 2 else _LOW
        if count % _PER_MARK == 0:
            marks.append((1e-9 * now, message.vector.x))
        publisher.publish(message)
        count += 1

    rclpy.init()
    try:
        node = rclpy.create_node('bench_vane')
        publisher = node.create_publisher(Vector3Stamped, 'wind', QoSProfile(depth=50))
        node.create_timer(1.0 / _RATE, blow)
        executor = SingleThreadedExecutor()
        executor.add_node(node)

        def spin(until: float) -> None:
            while time.monotonic() < until:
                executor.spin_once(timeout_sec=0.1)

        deadline = time.monotonic() + _START
        while time.monotonic() < deadline and not is_ready():
            spin(time.monotonic() + 0.2)
        spin(time.monotonic() + 3.0)  # what is compiled at first use is
        marks.clear()
        spin(time.monotonic() + seconds)
    finally:
        rclpy.try_shutdown()
    return marks
