# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Loads of steady winds on a tree held in many poses."""

from __future__ import annotations

import numpy as np

from tree_sway.core.scene.make import make_simulator
from tree_sway.core.setup.wind_moments import WindMoments


def test_the_load_in_each_of_many_poses_is_that_in_it_alone(fork):
    (bank,) = make_simulator(fork(), model=4).banks
    moments = WindMoments(bank.branches)
    rng = np.random.default_rng(3)
    poses, winds = rng.normal(0.0, 0.1, (5, moments.n)), rng.normal(0.0, 5.0, (5, 3))
    still = np.zeros(moments.n)
    alone = [moments(pose, still, wind) for pose, wind in zip(poses, winds, strict=True)]
    together = moments.at_poses(poses, winds)
    assert np.ptp(together, axis=0).max() > 1.0
    np.testing.assert_allclose(together, alone, rtol=1e-10, atol=1e-10)
