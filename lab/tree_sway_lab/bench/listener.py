# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The other process of `stream` and `latency`: receives poses, reports when each arrived."""

from __future__ import annotations

import json
import struct
import sys
import time


def stamp_of(data: bytes) -> int:
    """Time in [ns] in the header of a message in little-endian CDR."""
    seconds, nanoseconds = struct.unpack_from('<iI', data, 4)
    return int(seconds) * 1_000_000_000 + int(nanoseconds)


def main(seconds: float, topic: str = 'bench/segment_poses') -> None:
    """Listen until no frame has come for a second, at most this time after the first."""
    from geometry_msgs.msg import PoseArray
    import rclpy
    from rclpy.qos import QoSProfile

    stamps: list[int] = []
    arrivals: list[int] = []

    def receive(data: bytes) -> None:
        arrivals.append(time.time_ns())
        stamps.append(stamp_of(data))

    rclpy.init()
    node = rclpy.create_node('bench_listener')
    node.create_subscription(PoseArray, topic, receive, QoSProfile(depth=5), raw=True)
    executor = rclpy.executors.SingleThreadedExecutor()
    executor.add_node(node)
    begun, cpu = time.monotonic(), 0.0
    deadline = begun + 60.0
    while time.monotonic() < deadline:
        executor.spin_once(timeout_sec=0.2)
        if stamps and not cpu:
            cpu, deadline = time.process_time(), time.monotonic() + seconds
        if stamps and time.time_ns() - arrivals[-1] > 1_000_000_000:
            break
    spent = time.process_time() - cpu
    rclpy.try_shutdown()
    print(json.dumps({'stamps': stamps, 'arrivals': arrivals, 'cpu': spent}))


if __name__ == '__main__':
    main(float(sys.argv[1]))
