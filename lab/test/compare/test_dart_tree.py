# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The same bodies in two engines move alike."""

from __future__ import annotations

import numpy as np
import pytest
from tree_sway_lab.bench.bench_tree import bench_tree
from tree_sway_lab.compare.with_mujoco import mujoco_tips, without_twist
from tree_sway_lab.tip_error import tip_error

from tree_sway.core.species.species import species_named


def test_two_engines_agree_at_short_steps():
    pytest.importorskip('mujoco', reason='needs MuJoCo (pip install mujoco)')
    pytest.importorskip('dartpy', reason='needs DART (pip install dartpy)')
    from tree_sway_lab.compare.dart_tree import DartTree
    from tree_sway_lab.compare.mujoco_tree import MujocoTree

    tree = bench_tree(3, (4,))
    twin = MujocoTree(tree, without_twist(species_named(tree.species)), 0.05, even=False)
    wind = np.array([[6.0 + np.sin(0.2 * k), 1.0, 0.0] for k in range(60)])
    fine = np.repeat(wind, 20, axis=0)
    tips, cost = DartTree(twin, 1.0 / 1200.0).race(fine)
    assert cost > 0.0
    assert tip_error(tree, tips[19::20], mujoco_tips(twin, wind, 20)) < 0.02
