# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The state of the solver's trees on `tree_state`, from when somebody first listens."""

from __future__ import annotations

import math
import threading
from typing import Any

from tree_sway_ros.core.simulator.protocol import Simulator
from tree_sway_ros.errors import TreeSwayError
from tree_sway_ros.page.scene_state import SceneState
from tree_sway_ros.ros.process.topics import TREE_STATE
from tree_sway_ros.ros.timing.stepping import Divider
from tree_sway_ros.ros.wire.tree_state import state_entry, state_template


class StatePublisher:
    """
    Publishes `tree_state`, and has `tree_description` tell how to read it.

    The basis takes some seconds to find: it is found on a thread of its own, once somebody
    listens.
    """

    def __init__(self, node: Any, simulator: Simulator, n_leaves: int) -> None:
        self._node, self._simulator, self._n_leaves = node, simulator, n_leaves
        self._publisher = node.publisher(TREE_STATE, alone=True)
        rate = node.values['state_rate']
        self._every = max(1, math.ceil(node.values['rate'] / rate)) if rate > 0.0 else 0
        self._divider = Divider()
        self._template: Any = None
        self._scene: SceneState | None = None
        self._finder: threading.Thread | None = None
        node.on_close(self._wait)

    def publish(self, index: int, stamp: int) -> None:
        """Publish the state if one is due at a tick of that number and time [ns]."""
        if not self._every or not self._divider.is_due(index, self._every):
            return
        if self._publisher.get_subscription_count() == 0:
            return
        if self._scene is None:
            if self._finder is None:
                self._finder = threading.Thread(target=self._find, name='basis', daemon=True)
                self._finder.start()
            return
        block = self._template.blocks[0]
        block[:3] = self._simulator.wind
        block[3:] = self._scene.coordinates()
        self._publisher.publish(self._template.to_bytes(stamp))

    def _wait(self) -> None:
        if self._finder is not None:
            self._finder.join(timeout=10.0)

    def _find(self) -> None:
        try:
            frame_id = self._node.values['frame_id']
            scene = SceneState(self._simulator, self._n_leaves, frame_id)
            self._template = state_template(scene.coordinate_names, frame_id)
            self._node.stream.tell_more({'state': state_entry(scene.description)})
            self._scene = scene
        except TreeSwayError as error:
            self._node.get_logger().warning(f'no {TREE_STATE.name}: {error}')
        except Exception as error:
            self._node.slip(error)
