# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The publisher of `tree_state` beside a scene that is stepped and tuned."""

from __future__ import annotations

from pathlib import Path
import time
from types import SimpleNamespace
from typing import Any

import numpy as np

from tree_sway.core.scene.placed_tree import PlacedTree
from tree_sway.core.scene.scene import Scene
from tree_sway.core.scene.scene_simulator import SceneSimulator
from tree_sway.files.trees.source import open_tree
from tree_sway_ros.solver import StatePublisher

SEEDLING = Path(__file__).parents[2] / 'files' / 'data' / 'seedling.yaml'
DEADLINE = 60.0


def tuned_scene() -> SceneSimulator:
    """Make two trees on one table, softer than they were made, as the node does at its start."""
    source = open_tree(SEEDLING)
    scene = Scene([PlacedTree('one', source), PlacedTree('two', source, x=3.0)]).simulator(
        model=12
    )
    scene.tune(stiffness_factor=0.7)
    return scene


def swayed(scene: SceneSimulator, steps: int) -> None:
    """Step a scene in a steady wind, and tune it on the way."""
    for number in range(steps):
        if number == steps - 100:
            scene.tune(stiffness_factor=1.6)
        scene.step((5.0, 1.0, 0.0), 1.0 / 60.0)


def test_the_publisher_leaves_a_scene_that_is_tuned_as_it_is() -> None:
    described: list[dict[str, Any]] = []
    node = SimpleNamespace(
        values={'state_rate': 30.0, 'rate': 60.0, 'frame_id': 'map'},
        publisher=lambda _topic: None,
        stream=SimpleNamespace(add_to_description=described.append),
        on_close=lambda _close: None,
    )
    scene, undisturbed = tuned_scene(), tuned_scene()
    StatePublisher(node, scene, 0).start()
    deadline = time.monotonic() + DEADLINE
    while not described and time.monotonic() < deadline:
        swayed(scene, 200)
    assert described
    swayed(scene, 600)
    swayed(undisturbed, 600)
    for name in ('stiffness', 'damping'):
        tables = (each._shared._oscillators for each in (scene, undisturbed))
        own, expected = ([getattr(each.modal, name) for each in every] for every in tables)
        np.testing.assert_allclose(own, expected, rtol=1e-9)
    own, expected = (each.place() for each in (scene, undisturbed))
    np.testing.assert_allclose(own, expected, atol=1e-6)
    assert [group.simulator.counts.steps for group in scene.groups] == [0]
