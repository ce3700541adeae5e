# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What the model ``auto`` has to meet: tolerance, budget, and from where the trees are seen."""

from __future__ import annotations

from functools import partial
from typing import Any

from tree_sway.core.scene import Run
from tree_sway.fidelity import set_demand
from tree_sway_ros.process.node import TreeSwayNode
from tree_sway_ros.process.topics import CAMERA
from tree_sway_ros.reports.refusals import Refusals

_FARTHEST_CAMERA = 1e6
"""Distance along each axis [m]."""


class Demand:
    """The demand of a run's trees, by the parameters of a node and its topic `camera`."""

    def __init__(self, node: TreeSwayNode, run: Run, refusals: Refusals) -> None:
        self._values = node.values
        self._run = run
        self._refuse = refusals.note
        self._camera: tuple[float, float, float] | None = None
        node.subscription(CAMERA, self._see)

    def set(self) -> None:  # noqa: A003
        """Set the demand, in the thread of the steps."""
        set_demand(
            self._run.simulator.simulators,
            camera=self._camera,
            **self._values.subset('tolerance', 'tolerance_angle', 'budget'),
        )

    def request(self) -> None:
        """Let the demand be set before the next step, on the model ``auto``."""
        if self._values['model'] == 'auto':
            self._run.request(self.set, partial(self._refuse, 'change'))

    def _see(self, message: Any) -> None:
        at = message.pose.position
        camera = (at.x, at.y, at.z)
        if not all(abs(each) <= _FARTHEST_CAMERA for each in camera):  # false for NaN
            self._refuse('camera', 'not finite or too far away')
            return
        self._camera = camera
        self.request()
