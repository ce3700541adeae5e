# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Several trees in one wind: their places, delays of gusts, and accuracy.

`make` makes every kind of simulator. Nothing here draws or publishes.
"""

from typing import TYPE_CHECKING

from tree_sway.faces import face

if TYPE_CHECKING:
    from tree_sway.core.scene.demand import adaptive_among as adaptive_among
    from tree_sway.core.scene.demand import set_cost_scale as set_cost_scale
    from tree_sway.core.scene.demand import set_demand as set_demand
    from tree_sway.core.scene.local_wind import wind_at as wind_at
    from tree_sway.core.scene.make import make_simulator as make_simulator
    from tree_sway.core.scene.make import simulator_of as simulator_of
    from tree_sway.core.scene.make import solved as solved
    from tree_sway.core.scene.placed_tree import Kind as Kind
    from tree_sway.core.scene.placed_tree import LARGEST as LARGEST
    from tree_sway.core.scene.placed_tree import PlacedTree as PlacedTree
    from tree_sway.core.scene.placed_tree import SMALLEST as SMALLEST
    from tree_sway.core.scene.received_scene import ReceivedKind as ReceivedKind
    from tree_sway.core.scene.received_scene import ReceivedScene as ReceivedScene
    from tree_sway.core.scene.run import Run as Run
    from tree_sway.core.scene.scene import Scene as Scene
    from tree_sway.core.scene.scene_simulator import SceneSimulator as SceneSimulator
    from tree_sway.core.scene.scene_simulator import Simulator as Simulator
    from tree_sway.core.scene.shard import shard_of as shard_of
    from tree_sway.core.scene.table_export import exported_table as exported_table
    from tree_sway.core.scene.table_export import rounded as rounded
else:
    __getattr__, __dir__, __all__ = face(__name__)
