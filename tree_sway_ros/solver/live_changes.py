# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Changes while the trees sway: of the trees, and of what the model ``auto`` has to meet."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields
from functools import partial
from typing import Any

from tree_sway.core.run import Tuning
from tree_sway.core.scene import Run, set_demand
from tree_sway.errors import ParameterError
from tree_sway_ros.process.node import TreeSwayNode
from tree_sway_ros.process.topics import CAMERA
from tree_sway_ros.reports.refusals import Refusals

_FARTHEST_CAMERA = 1e6
"""Distance along each axis [m]."""

_LIVE = frozenset(each.name for each in fields(Tuning))


class LiveChanges:
    """
    Changes of a run's trees by the parameters of a node, and by its topic `camera`.

    Parameters
    ----------
    node
        The node.
    run
        Runtime of the trees.
    refusals
        Counts of refused changes.

    """

    def __init__(self, node: TreeSwayNode, run: Run, refusals: Refusals) -> None:
        self._values = node.values
        self._run = run
        self._refuse = refusals.note
        self._camera: tuple[float, float, float] | None = None
        self._tuned: dict[str, float] = {}
        node.subscription(CAMERA, self._see)

    def check(self, values: dict[str, Any]) -> None:
        """Raise a `ParameterError` for a change of the trees that is impossible."""
        changes = {k: v for k, v in values.items() if k in _LIVE and v != self._values[k]}
        if changes.get('damping_ratio') == 0.0:
            raise ParameterError(
                "the species' own damping while the tree sways",
                where='damping_ratio',
                cure='give the ratio itself; 0 is for the start',
            )
        if changes:
            # Beside those accepted before, which may still wait for the next step.
            self._run.simulator.check_tuning(**self._tuned | changes)

    def tune(self, values: dict[str, Any]) -> None:
        """Change the trees before the next step."""
        changes = {name: values[name] for name in _LIVE & {*values}}
        if changes:
            self._tuned |= changes
            self._request(partial(self._run.simulator.tune, **changes))

    def set_demand(self) -> None:
        """Set tolerance, budget, and from where the trees are seen, in the thread of the steps."""
        set_demand(
            self._run.simulator.simulators,
            camera=self._camera,
            **self._values.subset('tolerance', 'tolerance_angle', 'budget'),
        )

    def request_demand(self) -> None:
        """Let the demand be set before the next step, on the model ``auto``."""
        if self._values['model'] == 'auto':
            self._request(self.set_demand)

    def _request(self, action: Callable[[], object]) -> None:
        self._run.request(action, partial(self._refuse, 'change'))

    def _see(self, message: Any) -> None:
        at = message.pose.position
        camera = (at.x, at.y, at.z)
        if not all(abs(each) <= _FARTHEST_CAMERA for each in camera):  # false for NaN
            self._refuse('camera', 'not finite or too far away')
            return
        self._camera = camera
        self.request_demand()
