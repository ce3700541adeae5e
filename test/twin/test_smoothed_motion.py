# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The smoothed motion is late by a fixed number of steps."""

from __future__ import annotations

import numpy as np

from tree_sway.twin.smoothed_motion import LATE_STEPS, SmoothedMotion

M, N, STEPS = 5, 3, 90


def test_a_steady_change_is_late_by_the_stated_steps() -> None:
    smoothed, slope = SmoothedMotion(M, N), np.arange(1.0, M + 1.0)
    for k in range(STEPS):
        smoothed.note_computed(k, k * slope)
        smoothed.note_estimated(k, k, 0.0)
        smoothed.smooth(k, np.ones(N), None)
    np.testing.assert_allclose(smoothed.displacements, (STEPS - 1 - LATE_STEPS) * slope)


def test_the_difference_of_then_is_added_as_far_as_it_is_trusted() -> None:
    smoothed, trust = SmoothedMotion(M, N), np.array([0.0, 0.5, 1.0])
    for k in range(STEPS):
        smoothed.note_computed(k, np.ones(M))
        smoothed.note_estimated(k, k, np.full(N, 2.0))
        smoothed.smooth(k, trust, np.full(N, 4.0))
    np.testing.assert_allclose(smoothed.displacements, [1.0, 4.0, 7.0, 1.0, 1.0])
