# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Trees that stand somewhere, in one wind.

`PlacedTree` is a tree with place, size and yaw; `Scene` holds one, a forest or thousands, and
makes their `Simulator`: a `SwaySimulator` of one tree, a `SceneSimulator` of several, whose trees
of one kind share a table and step in one native call (`sharing`, `shared_tables`). `Run` is the
runtime that nodes, page and `simulate` have in common: the grid of time, gate and mean of the
wind, requests between steps.

Nothing here draws, publishes or reads files.
"""

from typing import TYPE_CHECKING

from tree_sway.faces import face

if TYPE_CHECKING:
    from tree_sway.core.scene.make import make_simulator as make_simulator
    from tree_sway.core.scene.make import simulator_of as simulator_of
    from tree_sway.core.scene.make import solved as solved
    from tree_sway.core.scene.placed_tree import Kind as Kind
    from tree_sway.core.scene.placed_tree import PlacedTree as PlacedTree
    from tree_sway.core.scene.placed_tree import SCALES as SCALES
    from tree_sway.core.scene.placement_records import own_step as own_step
    from tree_sway.core.scene.run import Run as Run
    from tree_sway.core.scene.scene import Scene as Scene
    from tree_sway.core.scene.scene_simulator import SceneSimulator as SceneSimulator
    from tree_sway.core.scene.scene_simulator import Simulator as Simulator
else:
    __getattr__, __dir__, __all__ = face(__name__)
