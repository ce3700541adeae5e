# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A topic of a sensor: one publisher, and stamps that are near the node's clock."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
import time

from tree_sway_ros.process.node import TreeSwayNode
from tree_sway_ros.reports.one_publisher import OnePublisher
from tree_sway_ros.solver import UNHEARD

_APART = 5_000_000_000
"""Largest difference of a stamp from the node's clock in [ns]."""


class FollowedTopic:
    """
    Samples of a topic that are admitted.

    Parameters
    ----------
    node
        The solver.
    name, type_name
        The topic, and the type of its messages, as ``sensor_msgs/Imu``.

    """

    def __init__(self, node: TreeSwayNode, name: str, type_name: str) -> None:
        self._node, self._name, self._type = node, name, type_name
        self._one = OnePublisher()
        self._publishers = partial(node.count_publishers, name)
        self._by = 0.0
        self.newest = UNHEARD
        """Stamp of the newest sample that was handed on, in [ns]."""
        self.apart = 0
        """Number of samples that were refused for their stamps."""

    @property
    def of_others(self) -> int:
        """Number of samples of other publishers, which were refused."""
        return self._one.refused

    def admitted(self, stamp: int, info: Mapping[str, object]) -> int | None:
        """Return a stamp in [ns], that of the clock for 0; None where the sample is refused."""
        if not self._one.admits(info, self._publishers, time.monotonic()):
            return None
        now = int(self._node.get_clock().now().nanoseconds)
        limits = self._node.stamp_limits
        by = (stamp or now) - now
        if not -_APART - limits['lag'] <= by <= _APART + limits['lead']:
            self.apart += 1
            self._by = by * 1e-9
            return None
        self._by = 0.0
        return stamp or now

    def lacks(self, read: int) -> bool:
        """Whether it has yet to send what is read up to a time in [ns]."""
        return self.newest <= read and (self.newest != UNHEARD or self._publishers() > 0)

    @property
    def clock_problem(self) -> str:
        """What is wrong with its stamps, and the cure; empty if the newest was admitted."""
        if not self._by:
            return ''
        return (
            f'{self.apart} refused: stamps differ from this clock by {self._by:.1f} s: '
            'synchronise the clocks (chrony, or that of micro-ROS)'
        )

    def faults(self) -> list[str]:
        """Return a sentence where several nodes publish."""
        return self._one.faults(self._node.publishers_of(self._name, self._type))
