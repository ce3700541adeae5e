# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The film of a tree with a sensor or a camera shows what its titles say."""

from __future__ import annotations

import numpy as np
import pytest
from tree_sway_lab.chart.twin import four_motions, Motions, SHOWN
from tree_sway_lab.twin.true_tree import tree_called


@pytest.mark.long
def test_what_sees_the_tree_brings_the_model_to_it() -> None:
    pytest.importorskip('cv2')
    motions = four_motions()
    assert all(np.isfinite(poses).all() and len(poses) == SHOWN for poses in motions.poses)
    alone, sensor, camera = motions.errors()
    print(f'error of the tip: {alone:.2f} in the wind alone, {sensor:.2f} with one sensor, ')
    print(f'{camera:.2f} with a camera')
    assert alone > 0.75
    assert sensor < 0.75 * alone
    assert camera < 0.25


def test_an_error_is_that_of_the_motion_about_its_mean() -> None:
    tree, _ = tree_called('spruce 4')
    sway = np.sin(np.linspace(0.0, 20.0, 200))[:, None, None]
    true = tree.rest_poses + sway * np.array([1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    leaning = true + np.array([0.5, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    half = tree.rest_poses + 0.5 * (true - tree.rest_poses)
    motions = Motions(tree, np.zeros((200, 3)), (true, half, leaning))
    assert motions.errors() == pytest.approx([0.5, 0.0])
