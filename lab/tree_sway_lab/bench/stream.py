# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The stream timed between two processes: what arrives, how late, and what it costs.

A listener in a process of its own takes the messages as bytes and reports when each arrived.

"""

from __future__ import annotations

import json
import os
from pathlib import Path
import select
import subprocess
import sys
import threading
import time
from typing import Any

import numpy as np

from tree_sway.commands import waiting
from tree_sway.errors import TransportError
from tree_sway_lab.bench.measured import Measured

_PATIENCE = 30.0
_PROFILES = ('FASTRTPS_DEFAULT_PROFILES_FILE', 'FASTDDS_DEFAULT_PROFILES_FILE')


def isolated(seed: int) -> dict[str, str]:
    """Environment of a domain of its own here, with room in shared memory for large frames."""
    places = Path(__file__).parents[3], Path(sys.prefix, 'share', 'tree_sway_ros')
    found = [place / 'config' / 'fastdds.xml' for place in places]
    room = {name: str(path) for path in found if path.is_file() for name in _PROFILES}
    return {
        **room,
        **os.environ,
        'ROS_DOMAIN_ID': str(100 + seed % 100),
        'ROS_AUTOMATIC_DISCOVERY_RANGE': 'LOCALHOST',
    }


def time_stream(
    n_poses: int = 10_000, rate: float = 60.0, seconds: float = 10.0
) -> list[Measured]:
    """
    Publish frames of poses to a listener.

    Parameters
    ----------
    n_poses
        Segments of a frame.
    rate
        Frames per second.
    seconds
        How long.

    Returns
    -------
    list of Measured
        Rate, loss, latency from stamp to arrival, and CPU time of both sides.

    Raises
    ------
    TransportError
        If the listener receives nothing.

    """
    environment = isolated(os.getpid())
    os.environ.update(environment)
    command = [sys.executable, '-m', 'tree_sway_lab.bench.listener', str(seconds + 2.0)]
    from geometry_msgs.msg import PoseArray
    import rclpy
    from rclpy.qos import QoSProfile

    from tree_sway_ros.wire import pose_array_template

    template = pose_array_template(n_poses, 'map')
    rclpy.init()
    try:
        node = rclpy.create_node('bench_stream')
        publisher = node.create_publisher(PoseArray, 'bench/segment_poses', QoSProfile(depth=5))
        with (
            waiting('streaming'),
            subprocess.Popen(command, env=environment, stdout=subprocess.PIPE, text=True) as child,
        ):
            _wait_for(publisher, child)
            pause = threading.Event()
            sent, begun, cpu = 0, time.monotonic(), time.process_time()
            while time.monotonic() < begun + seconds:
                publisher.publish(template.to_bytes(time.time_ns()))
                sent += 1
                pause.wait(max(0.0, begun + sent / rate - time.monotonic()))
            cpu = time.process_time() - cpu
            received = json.loads(child.communicate(timeout=seconds + _PATIENCE)[0] or '{}')
    finally:
        rclpy.try_shutdown()
    return _figures(received, sent, seconds, cpu, f'{n_poses} poses at {rate:g} Hz')


def _wait_for(publisher: Any, child: subprocess.Popen[str]) -> None:
    assert child.stdout is not None
    deadline = time.monotonic() + _PATIENCE
    while publisher.get_subscription_count() == 0:
        if time.monotonic() > deadline or child.poll() is not None:
            raise TransportError('no listener in 30 s', cure='see that localhost is not cut off')
        select.select([child.stdout], [], [], 0.02)


def _figures(
    received: dict[str, Any], sent: int, seconds: float, cpu: float, what: str
) -> list[Measured]:
    stamps, arrivals = np.array(received['stamps']), np.array(received['arrivals'])
    if not len(stamps):
        raise TransportError('nothing was received', cure='see that localhost is not cut off')
    late = 1e-6 * (arrivals - stamps)
    return [
        Measured(f'rate of {what}', len(stamps) / seconds, 'Hz'),
        Measured('lost', 1.0 - len(np.unique(stamps)) / sent, '-'),
        Measured('latency, p50', float(np.quantile(late, 0.5)), 'ms'),
        Measured('latency, p99', float(np.quantile(late, 0.99)), 'ms'),
        Measured('CPU of the sender', cpu / seconds, 'cores'),
        Measured('CPU of the listener', received['cpu'] / seconds, 'cores'),
    ]
