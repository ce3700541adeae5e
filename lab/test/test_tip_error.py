# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Tips from poses, their record, and the score of a model."""

import numpy as np
import pytest
from scipy.integrate import trapezoid
from scipy.spatial.transform import Rotation
from tree_sway_lab.example_trees import forked_tree, tapered_stem
from tree_sway_lab.frame_means import frame_means
from tree_sway_lab.tip_error import record_tips, tip_error

from tree_sway.core.tree.tree import tips_of_poses


class Turning:
    """A rigid stem that leans by the wind's x in [rad], and notes every step."""

    def __init__(self, tree):
        self.tree, self.steps, self.lean = tree, [], 0.0

    def step(self, wind, dt):
        self.steps.append((wind[0], dt))
        self.lean = wind[0]

    def place(self, out):
        lean = Rotation.from_rotvec([0.0, self.lean, 0.0])
        out[:, :3] = lean.apply(self.tree.start.copy())
        out[:, 3:] = (lean * Rotation.from_rotvec([0.0, -np.pi / 2, 0.0])).as_quat()


@pytest.mark.parametrize('seed', range(3))
def test_a_tip_is_a_length_ahead_along_the_poses_x(seed):
    tree, rng = forked_tree(0.5, 0.6, generations=2), np.random.default_rng(seed)
    turn = Rotation.from_quat(rng.normal(size=(tree.n_segments, 4)))
    poses = np.hstack([rng.normal(size=(tree.n_segments, 3)), turn.as_quat()])
    last = tree.branch_first[1:] - 1
    along = np.stack([tree.length, 0 * tree.length, 0 * tree.length], axis=1)
    expected = poses[:, :3] + turn.apply(along)
    assert tips_of_poses(tree, poses) == pytest.approx(expected[last])


def test_every_frame_is_stepped_in_its_own_wind_and_placed_once():
    tree = tapered_stem(2.0, [0.1, 0.08, 0.05])
    model, wind = Turning(tree), np.array([[0.1, 0, 0], [0.4, 0, 0]])
    tips = record_tips(model, tree, wind, 0.02, substeps=4)
    assert model.steps == [(0.1, 0.005)] * 4 + [(0.4, 0.005)] * 4
    expected = 2.0 * np.stack([np.sin([0.1, 0.4]), [0, 0], np.cos([0.1, 0.4])], axis=1)
    assert tips[:, 0] == pytest.approx(expected, abs=1e-12)


def test_the_score_is_error_over_motion():
    tree = tapered_stem(2.0, [0.1, 0.08, 0.05])
    rest = np.tile(tree.end[-1], (4, 1, 1))
    sway = np.array([1.0, -1.0, 2.0, 0.0])[:, None, None] * np.array([0.1, 0.0, 0.0])
    assert tip_error(tree, rest + 1.25 * sway, rest + sway) == pytest.approx(0.25)
    assert tip_error(tree, rest - sway, rest + sway) == pytest.approx(2.0)
    aside = rest + sway[..., ::-1]
    assert tip_error(tree, aside, rest + sway) == pytest.approx(np.sqrt(2.0)), 'at a right angle'


def test_means_over_frames_keep_the_integral():
    rng = np.random.default_rng(0)
    time = np.cumsum(rng.uniform(0.05, 0.2, 41))
    wind = rng.normal(size=(41, 3))
    dt = (time[-1] - time[0]) / 13
    whole = trapezoid(wind, time, axis=0)
    assert frame_means(time, wind, dt).sum(axis=0) * dt == pytest.approx(whole, abs=1e-12)
    steady = frame_means([0.0, 1.0], np.tile([3.0, 0.0, 1.0], (2, 1)), 0.3)
    assert steady == pytest.approx(np.tile([3.0, 0.0, 1.0], (3, 1))), (
        'a frame that is not full is left out'
    )
