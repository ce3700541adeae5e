# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The exported tree in MuJoCo's own wind, beside ours: how far all of its segments are from rest.

The file of ``tree-sway convert TREE -o tree.xml`` is loaded as a user would load it, and only the
wind of the engine's options is set before each frame.
"""

from __future__ import annotations

import numpy as np

from tree_sway.commands import bar
from tree_sway.core.arrays import Floats
from tree_sway.core.scene import make_simulator
from tree_sway.core.species import Species
from tree_sway.core.tree import Tree
from tree_sway.files.export import mjcf_of_tree, plain_names
from tree_sway_lab.compare.mujoco_tree import FRAME, mujoco_module

SETTLES = 5.0
"""Seconds at the beginning that do not count."""


def compare_exported_wind(tree: Tree, species: Species, wind: Floats) -> str:
    """
    Return how the exported tree sways in MuJoCo's wind, over ours, as text.

    Parameters
    ----------
    tree, species
        The tree and its wood.
    wind
        Wind of each frame [m/s], (n, 3), more of them than `SETTLES`.

    """
    mujoco = mujoco_module()
    simulator = make_simulator(tree, species)
    model = mujoco.MjModel.from_xml_string(mjcf_of_tree(simulator))
    data = mujoco.MjData(model)
    bodies = [model.body(name).id for name in plain_names(tree)]
    ours = np.empty((len(wind), tree.n_segments, 3))
    theirs = np.empty_like(ours)
    for frame, velocity in enumerate(bar(wind, 'MuJoCo')):
        simulator.step(velocity, FRAME)
        model.opt.wind[:] = velocity
        while data.time < (frame + 1) * FRAME:
            mujoco.mj_step(model, data)
        ours[frame] = simulator.place()[:, :3] - tree.start
        theirs[frame] = data.xpos[bodies] - tree.start
    first = round(SETTLES / FRAME)
    top = int(np.argmax(tree.start[:, 2]))
    rows = [
        row_of('all segments', ours[first:], theirs[first:]),
        row_of('the stem', ours[first:, _stem(tree)], theirs[first:, _stem(tree)]),
        row_of('the highest', ours[first:, [top]], theirs[first:, [top]]),
    ]
    head = f'{tree.name}: {tree.n_segments} segments, {len(wind) * FRAME:.0f} s'
    names = f'{"MuJoCo over ours":20s}{"mean":>8s}{"rms":>8s}{"r":>8s}'
    return '\n'.join([head, names, *rows])


def _stem(tree: Tree) -> list[int]:
    """Segments of the first branch."""
    return list(range(int(tree.branch_first[0]), int(tree.branch_first[1])))


def row_of(name: str, ours: Floats, theirs: Floats) -> str:
    """Ratio of the means and of the rms, and the correlation of displacements, (frames, k, 3)."""
    means = [np.linalg.norm(each.mean(axis=0), axis=-1).mean() for each in (ours, theirs)]
    sizes = [np.sqrt(np.mean(each**2)) for each in (ours, theirs)]
    swings = [(each - each.mean(axis=0)).ravel() for each in (ours, theirs)]
    correlation = np.corrcoef(swings[0], swings[1])[0, 1]
    return f'{name:20s}{means[1] / means[0]:8.3f}{sizes[1] / sizes[0]:8.3f}{correlation:8.3f}'
