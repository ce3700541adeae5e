# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A limb that is pushed is shown where the simulator has it."""

from __future__ import annotations

import numpy as np
import pytest

from tree_sway.core.settings import Settings
from tree_sway.files.trees.source import open_scene
from tree_sway.stream.placing import Placer
from tree_sway.stream.protocol import decode_description, decode_frame
from tree_sway.stream.scene_state import SceneState

DT, SETTLING = 1.0 / 60.0, 5.0


@pytest.mark.parametrize('name', ['goldcrest', pytest.param('benjamina', marks=pytest.mark.long)])
def test_a_limb_that_gives_way_is_shown_so(name):
    sim = open_scene(name).simulator(Settings(damping_ratio=0.5), model=60)
    tree, state = sim.tree, SceneState(sim)
    described = decode_description(state.description)
    lengths = np.add.reduceat(tree.length, tree.branch_first[:-1])
    limbs = np.flatnonzero(tree.branch_parent == 0)
    rest, errors = sim.place().copy(), []
    for branch in limbs[np.argsort(lengths[limbs])[::-1][:13:3]]:
        first, end = tree.branch_first[branch : branch + 2]
        segment = int(first + round(0.7 * (end - first - 1)))
        sim.reset()
        force = 0.01 * np.cross(tree.end[segment] - tree.start[segment], (0.3, 0.2, 1.0))
        for _ in range(round(SETTLING / DT)):
            sim.push(segment, force, 1.0, along=0.0)
            sim.step((0.0, 0.0, 0.0), DT)
        frame = decode_frame(state.frame(0))
        shape = np.concatenate([described.coordinates(frame), frame.beyond])
        own, shown = (
            each[segment, :3] - rest[segment, :3]
            for each in (sim.place(), Placer(described).place(shape))
        )
        errors.append(np.linalg.norm(shown - own) / np.linalg.norm(own))
    assert max(errors) < 0.03
