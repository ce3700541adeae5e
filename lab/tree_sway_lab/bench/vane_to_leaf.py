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

from collections.abc import Iterator
import contextlib
from itertools import pairwise
import os
import socket
import subprocess
import sys
import time

import numpy as np

from tree_sway.commands.progress import waiting
from tree_sway.core.arrays import Floats
from tree_sway.errors import TransportError
from tree_sway.page.client import StreamClient
from tree_sway.page.protocol import Frame
from tree_sway_lab.bench.measured import Measured
from tree_sway_lab.bench.stream import isolated

_RATE, _PER_MARK = 19.3, 10
_LOW, _HIGH, _SHOWN = 5.0, 8.0, 0.1
_START = 120.0
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
    seen = {
        way: Seen(f'http://127.0.0.1:{port}/', by_wind=way == 'by wind')
        for way in ('by state', 'by wind')
    }
    with (
        waiting('wind, solver and viewer in processes of their own'),
        _started(given, environment),
    ):
        marks = _blow(seen, seconds)
    rows = []
    for way, each in seen.items():
        late = 1e3 * each.late(marks)
        if len(late) == 0:
            raise TransportError(
                'no jump of the wind arrived', where=way, cure='ask for more --seconds'
            )
        for what, times in zip(('', ', shown'), late.T, strict=True):
            rows += [
                Measured(f'vane to leaf {way}{what}, p{share}', float(value), 'ms')
                for share, value in zip(
                    (50, 95, 99), np.percentile(times, (50, 95, 99)), strict=True
                )
            ]
    return rows


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


def _blow(seen: dict[str, Seen], seconds: float) -> list[tuple[float, float]]:
    """Publish samples until the clients have followed for a time [s]; returns the marks."""
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

        with contextlib.ExitStack() as stack:
            clients = [stack.enter_context(each.client) for each in seen.values()]
            deadline = time.monotonic() + _START
            while time.monotonic() < deadline and not all(c.playout.received for c in clients):
                spin(time.monotonic() + 0.2)
            spin(time.monotonic() + 3.0)  # what is compiled at first use is
            marks.clear()
            spin(time.monotonic() + seconds)
    finally:
        rclpy.try_shutdown()
    return marks
