# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The kernel of the dragged motion moves as its numpy twin."""

from __future__ import annotations

import numpy as np

from tree_sway.core.observe.dragged_motion import move_dragged, move_dragged_in_numpy


def test_the_kernel_moves_as_its_numpy_twin() -> None:
    rng = np.random.default_rng(2)
    law, drag = rng.normal(size=(2, 3, 7)), rng.normal(size=(7, 4))
    trust, rates = rng.uniform(size=4), rng.normal(size=4)
    one, other = np.zeros((2, 3, 7))
    for _ in range(3):
        move_dragged(law, drag, trust, rates, 2, one)
        move_dragged_in_numpy(law, drag, trust, rates, 2, other)
    assert np.abs(one).max() > 1.0
    np.testing.assert_allclose(one, other, rtol=1e-9)
