# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The state of a node for people and for `/diagnostics`: a level, a sentence and some values."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from rclpy.clock import Clock, ClockType

from tree_sway_ros.ros.process.topics import DIAGNOSTICS, qos_profile

OK, WARN, ERROR, STALE = 0, 1, 2, 3
PERIOD = 1.0
"""
From one report to the next [s], of wall time: reports go on while simulated time stands still.

"""


@dataclass(frozen=True)
class Status:
    """One line of a report of something, as ``wind``: level, a sentence, and figures by name."""

    name: str
    level: int
    message: str
    values: Mapping[str, object] = field(default_factory=dict)


def status_array(statuses: list[Status], *, prefix: str, hardware: str, stamp: Any) -> Any:
    """Make a DiagnosticArray of some statuses."""
    message = DiagnosticArray()
    message.header.stamp = stamp
    for status in statuses:
        item = DiagnosticStatus()
        item.level = bytes([status.level])
        item.name = f'{prefix}: {status.name}'
        item.message = status.message
        item.hardware_id = hardware
        item.values = [
            KeyValue(key=str(key), value=_text(value)) for key, value in status.values.items()
        ]
        message.status.append(item)
    return message


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


def _text(value: object) -> str:
    return f'{value:.6g}' if isinstance(value, float) else str(value)
