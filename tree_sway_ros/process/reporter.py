# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Publishes the state of a node on `/diagnostics`, once per second."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray
from rclpy.clock import Clock, ClockType

from tree_sway_ros.process.topics import DIAGNOSTICS, qos_profile
from tree_sway_ros.reports.diagnostics import Status, status_array

PERIOD = 1.0
"""
From one report to the next [s], of wall time: reports go on while simulated time stands still.

"""


class Reporter:
    """
    Publishes the statuses that `collect` returns once per second, by the clock of a node.

    ``hardware`` is what is reported on, for example the tree's name.
    """

    def __init__(self, node: Any, hardware: str, collect: Callable[[], list[Status]]) -> None:
        self._node = node
        self._hardware = hardware
        self._collect = collect
        self._publisher = node.create_publisher(
            DiagnosticArray, DIAGNOSTICS.name, qos_profile(DIAGNOSTICS)
        )
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        self._timer = node.create_timer(PERIOD, self.report, clock=steady)

    def report(self) -> None:
        """Publish one report."""
        self._publisher.publish(
            status_array(
                self._collect(),
                prefix=self._node.get_fully_qualified_name().lstrip('/'),
                hardware=self._hardware,
                stamp=self._node.get_clock().now().to_msg(),
            )
        )
