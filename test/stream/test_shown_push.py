# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A limb that is pushed is shown where all coordinates would have it."""

from __future__ import annotations

import numpy as np
import pytest

from tree_sway.core.run.pushes import Touch
from tree_sway.core.settings import Settings
from tree_sway.core.setup.reductions import TreeReductions
from tree_sway.files.trees.source import open_scene
from tree_sway.stream.placing import Placer
from tree_sway.stream.protocol import decode_description, decode_frame
from tree_sway.stream.scene_state import SceneState

DT, CALM, SETTLING = 1.0 / 60.0, (0.0, 0.0, 0.0), 5.0


@pytest.mark.parametrize('name', ['goldcrest', pytest.param('benjamina', marks=pytest.mark.long)])
def test_a_limb_gives_way_as_with_all_coordinates_and_is_shown_so(name):
    sim = open_scene(name).simulator(Settings(damping_ratio=0.5), model=60)
    tree, state = sim.tree, SceneState(sim)
    described = decode_description(state.description)
    reductions = TreeReductions(sim.tree, sim.models[0].species, sim.settings)
    factors, n_rotations = reductions.with_subtrees.reduction.factors, len(sim.rotations())
    lengths = np.add.reduceat(tree.length, tree.branch_first[:-1])
    limbs = np.flatnonzero(tree.branch_parent == 0)
    longest = limbs[np.argsort(lengths[limbs])[::-1][:7:3]]
    errors = []
    for branch in longest:
        first, end = tree.branch_first[branch : branch + 2]
        touch = Touch(tree, sim.banks[0])
        segment = int(first + round(0.7 * (end - first - 1)))
        touch.add(segment, (1.0, 0.0, 0.0), 1.0, 0.0)
        push, x = touch.pushes[segment], np.zeros(n_rotations)
        touch._renew(push, tree.start[segment], x)
        whole = push.lever @ factors.solve(push.lever.T)
        _, across = np.linalg.eigh(whole)
        for way in across.T[1:]:
            goal = whole @ way  # of little forces, so 1 mm far
            force = 0.001 / np.linalg.norm(goal) * way
            sim.reset()
            for _ in range(round(SETTLING / DT)):
                sim.push(segment, force, 1.0, along=0.0)
                sim.step(CALM, DT)
            frame = decode_frame(state.frame(0))
            shape = np.concatenate([described.coordinates(frame), frame.beyond])
            goal *= 0.001 / np.linalg.norm(goal)
            moves = [each[segment, :3] - tree.start[segment] for each in
                     (sim.place(), Placer(described).place(shape))]  # fmt: skip
            errors.append([np.linalg.norm(each - goal) / 0.001 for each in moves])
    own, shown = np.max(errors, axis=0)
    print(f'{name}: 60 coordinates are up to {own:.4f} off, as shown {shown:.4f}')
    assert own < 0.03
    assert shown < 0.03
