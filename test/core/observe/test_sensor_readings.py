# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What sensors would measure by the motion of the model: compiled, in numpy, and as a product."""

from __future__ import annotations

import numpy as np
import pytest

from tree_sway.core.observe.sensor_readings import compute, compute_in_numpy
from tree_sway.core.observe.sensor_spectrum import keep, keep_in_numpy
from tree_sway.core.observe.sensor_track import ROWS

M, N = 7, 4


@pytest.mark.parametrize('count', [0, 1, 3])
def test_measurements_are_rows_by_the_state(count: int) -> None:
    rng = np.random.default_rng(count)
    rows, damping = rng.normal(size=(3, M, ROWS * count)), rng.random(N)
    state = rng.normal(size=(3, M))
    for each in (compute, compute_in_numpy):
        sensed, still = np.zeros((2, count, ROWS)), np.zeros((2, N))
        each(rows, damping, *state, 1, sensed, still)
        expected = np.einsum('sj,sjr->r', state, rows)
        np.testing.assert_allclose(sensed[1].ravel(), expected, atol=1e-12)
        np.testing.assert_allclose(still[1], damping * state[1, :N] + state[2, :N])
        assert not sensed[0].any()
        assert not still[0].any()


def test_a_step_of_a_spectrum_is_kept_as_in_numpy() -> None:
    rng = np.random.default_rng(5)
    motion, watched, force = rng.normal(size=3), rng.normal(size=3), rng.normal(size=N)
    one, other = np.zeros((2, N + 4, 3, 5))
    keep(one, 1, 2, motion, force, watched)
    keep_in_numpy(other, 1, 2, motion, force, watched)
    np.testing.assert_array_equal(one, other)
    np.testing.assert_array_equal(one[:2, 1, 2], motion[:2])
    assert np.count_nonzero(one) == N + 4
