# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The one tree of a scene, with motion sensors on the real one."""

from __future__ import annotations

from typing import Any

from tree_sway.core.scene import Scene
from tree_sway.core.settings import Settings
from tree_sway.errors import ParameterError
from tree_sway.twin.camera import Camera, FilmedTree
from tree_sway.twin.observed_tree import ObservedTree


def observed_scene(
    scene: Scene, settings: Settings, camera: Camera | None = None, **sensors: Any
) -> ObservedTree:
    """
    Make the simulator of the one tree of a scene with motion sensors on the real one.

    Parameters
    ----------
    scene, settings
        The scene, and settings as for `Scene.simulator`.
    camera
        Camera that films the real tree, if there is one.
    **sensors
        ``at``, ``rate`` and other arguments of `ObservedTree`.

    Raises
    ------
    ParameterError
        A scene of several trees, or an error of `ObservedTree`.

    """
    if not scene.is_one_tree:
        what = f'motion sensors on a scene of {len(scene.trees)} trees'
        raise ParameterError(what, where=scene.name, cure='open the tree that they are on')
    one = scene.trees[0]
    where = scene.settings_of(0, settings)
    if camera is not None:
        return FilmedTree(one.placed(), one.species, where, camera=camera, **sensors)
    return ObservedTree(one.placed(), one.species, where, **sensors)
