# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A host's own process of `shards`: receives all shards, and publishes the wind if asked to."""

from __future__ import annotations

from functools import partial
import json
import math
import select
import sys
import time
from typing import Any

_WIND_RATE = 20.0


def main(sends_wind: bool, n_shards: int) -> None:
    """Report that all shards are received; at a line of input report when each frame arrived."""
    from geometry_msgs.msg import PoseArray, Vector3Stamped
    import rclpy
    from rclpy.executors import SingleThreadedExecutor
    from rclpy.qos import QoSProfile

    rclpy.init()
    node = rclpy.create_node('bench_side')
    arrivals: list[list[float]] = [[] for _ in range(n_shards)]

    def take(shard: int, _data: bytes) -> None:
        arrivals[shard].append(time.monotonic())

    for shard in range(n_shards):
        node.create_subscription(
            PoseArray, f'/shard{shard}/segment_poses', partial(take, shard), QoSProfile(depth=5),
            raw=True,
        )  # fmt: skip
    if sends_wind:
        publisher = node.create_publisher(Vector3Stamped, '/wind/filtered', QoSProfile(depth=5))
        node.create_timer(1.0 / _WIND_RATE, partial(_blow, publisher))
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    is_ready = False
    while not select.select([sys.stdin], [], [], 0.0)[0]:
        executor.spin_once(timeout_sec=0.1)
        if not is_ready and all(arrivals):
            is_ready = True
            print('ready', flush=True)
    rclpy.try_shutdown()
    print(json.dumps(arrivals), flush=True)


def _blow(publisher: Any) -> None:
    from geometry_msgs.msg import Vector3Stamped

    message, now = Vector3Stamped(), time.time_ns()
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(now, 1_000_000_000)
    message.header.frame_id = 'map'
    message.vector.x = 6.0 + 2.0 * math.sin(1e-9 * (now % 60_000_000_000))
    publisher.publish(message)


if __name__ == '__main__':
    main(sys.argv[1] == '1', int(sys.argv[2]))
