# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The trees that a solver sways, where they stand, and the settings of their model."""

from __future__ import annotations

from dataclasses import replace
import math

from tree_sway.core.scene import Scene
from tree_sway.core.settings import Settings
from tree_sway.core.setup import LEAVES
from tree_sway.core.species import species_named
from tree_sway.core.wind import WindProfile
from tree_sway.errors import ParameterError
from tree_sway.files.trees import open_scene
from tree_sway_ros.parameters.declaration import ParameterValues
from tree_sway_ros.solver.shard import shard_of


def scene_of(values: ParameterValues) -> Scene:
    """Open the trees that parameters name."""
    named = values['species']
    source = open_scene(
        values['tree'],
        wood=lambda found: species_named(named) if named else found,
        in_leaf=LEAVES[values['leaves']],
        warn=False,
    )
    x, y, z, yaw = values['pose']
    moved = source.moved(x=x, y=y, z=z, yaw=yaw)
    shard = shard_of(moved, values['shard.index'], values['shard.count'])
    if len(shard.trees) == 1 < len(moved.trees) and moved.anemometer is None:
        # The place of the first tree would be an anemometer that it stands apart from.
        note = 'the only tree of its shard: gusts reach it without the delay from the first tree'
        return replace(shard, anemometer=None, notes=(*shard.notes, note))
    return shard


def settings_of(values: ParameterValues) -> Settings:
    """Return the settings of the model by the parameters."""
    bearing = values['anemometer_bearing']
    if -1.0 < bearing < 0.0:
        cure = f'give {bearing + math.tau:.4g} [rad], or -1 if it is unknown'
        raise ParameterError(f'{bearing:g} is below 0', where='anemometer_bearing', cure=cure)
    return Settings(
        **values.subset('model', 'gravity', 'anemometer_distance', 'gusts', 'gust_seed'),
        anemometer_bearing=None if bearing < 0.0 else bearing,
        volume_stiffness=values['volume_rule.stiffness'],
        volume_damping=values['volume_rule.damping'],
        in_leaf=LEAVES[values['leaves']],
        damping_ratio=values['damping_ratio'] or None,
        profile=WindProfile(values['profile'], values['anemometer_height']),
    )
