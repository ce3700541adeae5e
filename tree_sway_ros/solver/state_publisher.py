# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The state of the solver's trees on `tree_state`."""

from __future__ import annotations

import math
from typing import Any

from tree_sway.core.scene import Run, Simulator
from tree_sway.errors import TreeSwayError
from tree_sway.stream import PAUSED, SceneState, WIND_LOST
from tree_sway_ros.process.topics import TREE_STATE
from tree_sway_ros.timing.divider import Divider
from tree_sway_ros.wire.tree_state import ModalState, state_entry, StateWriter


class StatePublisher:
    """
    Publishes `tree_state` to subscribers, and its description in `tree_description`.

    A tree that cannot be described has no state, which is logged.
    """

    def __init__(self, node: Any, simulator: Simulator, n_leaves: int) -> None:
        self._node = node
        self._simulator = simulator
        self._n_leaves = n_leaves
        self._publisher = node.publisher(TREE_STATE)
        rate = node.values['state_rate']
        self._every = max(1, math.ceil(node.values['rate'] / rate)) if rate > 0.0 else 0
        self._divider = Divider()
        self._writer: StateWriter | None = None
        self._scene: SceneState | None = None

    def start(self) -> None:
        """Describe the trees, unless they are or states are not wanted."""
        if self._every and self._scene is None:
            self._describe()

    def publish(self, index: int, stamp: int, run: Run) -> None:
        """Publish the state of a run if one is due at a tick of that number and time [ns]."""
        if not self._every or not self._divider.is_due(index, self._every):
            return
        if self._scene is None or self._publisher.get_subscription_count() == 0:
            return
        flags = PAUSED * run.is_paused + WIND_LOST * run.is_wind_lost
        coordinates = self._scene.coordinates()
        if self._writer is None or self._writer.count != len(coordinates):
            self._writer = StateWriter(len(coordinates))
        state = ModalState(stamp, self._simulator.wind, flags, coordinates)
        self._publisher.publish(self._writer.to_bytes(state))

    def _describe(self) -> None:
        try:
            frame_id = self._node.values['frame_id']
            scene = SceneState(self._simulator, self._n_leaves, frame_id)
            entry = state_entry(scene.description, scene.coordinate_names)
            self._node.stream.add_to_description({'state': entry})
            self._scene = scene
        except TreeSwayError as error:
            self._node.get_logger().warning(f'no {TREE_STATE.name}: {error}')
        except Exception as error:
            self._node.note_failure(error)
