# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A node beside the work of a program, spun when the program has time for it."""

from __future__ import annotations

import time
from typing import Any, TypeVar

from tree_sway_ros.process.spin import create, own_context

_LOOK = 0.2  # [s]: interval of checks for Ctrl-C while no messages arrive

_Own = TypeVar('_Own', bound='Listener')


class Listener:
    """
    A node with its own executor; without a context it has its own, which ends with it.

    Raises
    ------
    MissingDependencyError
        Without ROS.
    TransportError
        If the domain cannot be used.

    """

    def __init__(self, name: str, namespace: str = '', context: Any = None) -> None:
        self._own = own_context() if context is None else None
        from rclpy.executors import SingleThreadedExecutor
        from rclpy.node import Node

        within = context or self._own
        self.node: Any = create(
            lambda **given: Node(name, **given), context=within, namespace=namespace
        )
        self._executor = SingleThreadedExecutor(context=within)
        self._executor.add_node(self.node)

    def spin(self, seconds: float) -> None:
        """Handle messages for a time [s]."""
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0.0:
            self._executor.spin_once(timeout_sec=min(left, _LOOK))

    def spin_once(self, seconds: float) -> None:
        """Handle the next message within a time [s]."""
        self._executor.spin_once(timeout_sec=seconds)

    def close(self) -> None:
        """Leave the graph."""
        self._executor.shutdown(timeout_sec=1.0)
        self.node.destroy_node()
        if self._own is not None:
            self._own.try_shutdown()

    def __enter__(self: _Own) -> _Own:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
