# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Tips of a 40-branch tree in a turning, gusty wind, by MuJoCo at a step that has converged.

Run from the root of the repository, some five minutes, with MuJoCo installed (``pip install
mujoco``)::

    python test/golden/mujoco/make_golden.py

Writes ``forked_tips.npz`` beside this file: `wind` (t, 3) in [m/s], one mean a frame of 1/60 s;
tips (t / 2, 40, 3) in [m] at every other frame, `same` with the springs of the articulated
reference and `beam` with all of them scaled to the beam's static sway; `agreement` of the latter
with the beam model (first frequency, static sway); and `step_error`, tip error over tip motion
when the step is doubled.

"""

from pathlib import Path

import numpy as np
from tree_sway_lab.compare.mujoco_tree import MujocoTree
from tree_sway_lab.example_trees import forked_tree
from tree_sway_lab.tip_error import tip_error

from tree_sway.core.species.species import Species

FRAME, STEPS = 1.0 / 60.0, 32
SPECIES = Species('forked', 'no twist', 8.0e9, 900.0, drag_coefficient=1.2, shear_ratio=500.0)
DAMPING = 0.05


def gusty_wind(duration):
    """Wind that gusts and turns, as sums of sines, mean of each frame, (t, 3)."""
    t = (np.arange(round(duration / FRAME)) + 0.5) * FRAME
    speed = 9.0 + 3.0 * np.sin(2.2 * t) + 2.0 * np.sin(7.1 * t + 1.0) + np.sin(16.0 * t)
    heading = 0.4 * t + 0.5 * np.sin(1.3 * t)
    return np.stack([speed * np.cos(heading), speed * np.sin(heading), 0.1 * speed], axis=1)


def record(model, wind, steps):
    """Tips at every other frame, (t / 2, b, 3)."""
    tips = []
    for frame, blowing in enumerate(wind):
        for _ in range(steps):
            model.step(blowing, FRAME / steps)
        if frame % 2:
            tips.append(model.tips())
    return np.array(tips)


def main():
    """Write the file."""
    tree = forked_tree(0.5, 0.6)
    wind = gusty_wind(5.0)
    same = record(MujocoTree(tree, SPECIES, DAMPING, match_beam=False), wind, STEPS)
    model = MujocoTree(tree, SPECIES, DAMPING)
    beam = record(model, wind, STEPS)
    agreement = model.agreement()
    doubled = record(model, wind, STEPS // 2)
    error = tip_error(tree, doubled, beam)
    np.savez_compressed(
        Path(__file__).with_name('forked_tips.npz'),
        wind=wind,
        same=same.astype(np.float32),
        beam=beam.astype(np.float32),
        agreement=agreement,
        step_error=error,
    )
    print(f'agreement with the beam {agreement}, error of a doubled step {error:.2e}')


if __name__ == '__main__':
    main()
