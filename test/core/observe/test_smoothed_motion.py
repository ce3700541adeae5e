# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The smoothed motion is late by a fixed number of steps, compiled as in numpy."""

from __future__ import annotations

import numpy as np
import pytest

from tree_sway.core.kernel import WHY_PLAIN
from tree_sway.core.observe.smoothed_motion import LATE_STEPS, SMOOTHED_LAG, SmoothedMotion

M, N, STEPS = 5, 3, 90
PLAIN = [bool(WHY_PLAIN), True]


@pytest.mark.parametrize('plain', PLAIN)
def test_a_steady_change_is_late_by_the_stated_steps(plain: bool) -> None:
    smoothed, slope = SmoothedMotion(M, N, plain=plain), np.arange(1.0, M + 1.0)
    for k in range(STEPS):
        smoothed.note_computed(k, k * slope)
        smoothed.note_estimated(k, k, 0.0)
        smoothed.smooth(k, np.ones(N), None)
    np.testing.assert_allclose(smoothed.displacements, (STEPS - 1 - LATE_STEPS) * slope)


@pytest.mark.parametrize('plain', PLAIN)
def test_the_difference_of_then_is_added_as_far_as_it_is_trusted(plain: bool) -> None:
    smoothed, trust = SmoothedMotion(M, N, plain=plain), np.array([0.0, 0.5, 1.0])
    for k in range(STEPS):
        smoothed.note_computed(k, np.ones(M))
        smoothed.note_estimated(k, k, np.full(N, 2.0))
        smoothed.smooth(k, trust, np.full(N, 4.0))
    np.testing.assert_allclose(smoothed.displacements, [1.0, 4.0, 7.0, 1.0, 1.0])


@pytest.mark.skipif(bool(WHY_PLAIN), reason='nothing is compiled')
def test_compiled_and_in_numpy_it_is_the_same() -> None:
    rng = np.random.default_rng(4)
    both = [SmoothedMotion(M, N, plain=plain) for plain in (False, True)]
    for k in range(STEPS):
        computed, estimated = rng.normal(size=M), rng.normal(size=N)
        trust, change = rng.random(N), rng.normal(size=N)
        for each in both:
            each.note_computed(k, computed)
            each.note_estimated(max(k - SMOOTHED_LAG, 0), k, estimated)
            each.smooth(k, trust, change if k % 3 else None)
        one, other = (each.displacements for each in both)
        np.testing.assert_allclose(one, other, atol=1e-13)
