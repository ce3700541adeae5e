# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""From the stamp of a wind to the arrival of the first pose of a later stamp."""

from __future__ import annotations

import os
import subprocess
import sys
import time

import numpy as np

from tree_sway.commands import waiting
from tree_sway.errors import TransportError
from tree_sway_lab.bench.listener import stamp_of
from tree_sway_lab.bench.measured import Measured
from tree_sway_lab.bench.stream import isolated

_WIND_RATE = 20.0
_START = 120.0


def time_latency(
    tree: str = 'benjamina', rate: float = 60.0, seconds: float = 10.0
) -> list[Measured]:
    """
    Send winds to a solver in another process and wait for its poses.

    Parameters
    ----------
    tree
        Name or path of the tree.
    rate
        Frames per second of the solver.
    seconds
        How long.

    Returns
    -------
    list of Measured
        Time from the start of the solver to its first pose, which the first time compiles, in [s];
        latency in [ms], and in periods of the solver.

    Raises
    ------
    TransportError
        If the solver sends nothing.

    """
    environment = isolated(os.getpid() + 1)
    os.environ.update(environment)
    program = 'from tree_sway_ros.nodes.executables import solver; raise SystemExit(solver())'
    given = [
        '-p',
        f'tree:={tree}',
        '-p',
        f'rate:={rate}',
    ]
    command = [sys.executable, '-c', program, '--ros-args', *given]
    from geometry_msgs.msg import PoseArray, Vector3Stamped
    import rclpy
    from rclpy.executors import SingleThreadedExecutor
    from rclpy.qos import QoSProfile

    winds: list[int] = []
    poses: list[tuple[int, int]] = []

    def blow() -> None:
        message = Vector3Stamped()
        now = time.time_ns()
        message.header.stamp.sec, message.header.stamp.nanosec = divmod(now, 1_000_000_000)
        message.header.frame_id = 'map'
        message.vector.x = 5.0 + 0.01 * (len(winds) % 7)
        publisher.publish(message)
        winds.append(now)

    rclpy.init()
    try:
        node = rclpy.create_node('bench_latency')
        publisher = node.create_publisher(Vector3Stamped, 'wind/filtered', QoSProfile(depth=5))
        node.create_subscription(
            PoseArray,
            'segment_poses',
            lambda data: poses.append((stamp_of(data), time.time_ns())),
            QoSProfile(depth=5),
            raw=True,
        )
        node.create_timer(1.0 / _WIND_RATE, blow)
        executor = SingleThreadedExecutor()
        executor.add_node(node)
        with waiting('a solver in another process'):
            child = subprocess.Popen(command, env=environment, stderr=subprocess.DEVNULL)
            begun = time.monotonic()
            try:
                deadline = begun + _START
                while not poses and time.monotonic() < deadline and child.poll() is None:
                    executor.spin_once(timeout_sec=0.1)
                start = time.monotonic() - begun
                winds.clear()
                poses.clear()
                deadline = time.monotonic() + seconds
                while time.monotonic() < deadline:
                    executor.spin_once(timeout_sec=0.1)
            finally:
                child.terminate()
                child.wait()
    finally:
        rclpy.try_shutdown()
    if not poses:
        raise TransportError('the solver sent no poses', where=tree, cure='run it by itself first')
    stamps, arrivals = np.array(poses).T
    first = np.searchsorted(stamps, winds)
    moved = first < len(stamps)
    late = 1e-6 * (arrivals[first[moved]] - np.array(winds)[moved])
    p50, p95, p99 = np.quantile(late, [0.5, 0.95, 0.99]).tolist()
    return [
        Measured('start to first pose', start, 's'),
        Measured('wind to pose, p50', p50, 'ms'),
        Measured('wind to pose, p95', p95, 'ms'),
        Measured('wind to pose, p99', p99, 'ms'),
        Measured('p50 in periods', p50 * rate / 1e3, '-'),
        Measured('p99 in periods', p99 * rate / 1e3, '-'),
    ]
