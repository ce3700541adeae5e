# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The one tree of a scene, with motion sensors on the real one."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from tree_sway.core.scene import Scene
from tree_sway.core.settings import Settings
from tree_sway.errors import ParameterError
from tree_sway.twin.observed_tree import ObservedTree


def observed_scene(
    scene: Scene,
    settings: Settings,
    kind: Callable[..., ObservedTree] = ObservedTree,
    **sensors: Any,
) -> ObservedTree:
    """
    Make the simulator of the one tree of a scene with motion sensors on the real one.

    Parameters
    ----------
    scene, settings
        The scene, and settings as for `Scene.simulator`.
    kind
        What makes it: `ObservedTree`, or `FilmedTree` where a camera films the real tree.
    **sensors
        ``at``, ``rate`` and other arguments of that.

    Raises
    ------
    ParameterError
        A scene of several trees, or an error of `ObservedTree`.

    """
    if not scene.is_one_tree:
        what = f'motion sensors on a scene of {len(scene.trees)} trees'
        raise ParameterError(what, where=scene.name, cure='open the tree that they are on')
    one = scene.trees[0]
    return kind(one.placed(), one.species, scene.settings_of(0, settings), **sensors)
