# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The share of a motion that the wind explains, against closed forms."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tree_sway.twin.explained_motion import ExplainedMotion

DT = 1.0 / 60.0


@pytest.mark.parametrize('size', [0.0, 0.3, 0.8, 2.0])
def test_the_share_is_one_less_the_energy_of_the_correction(size: float) -> None:
    explained, stiffness = ExplainedMotion(), np.array([4.0, 100.0])
    for k in range(200 * 60):
        # A lean that stays is no motion, whoever tells of it.
        swing = np.array([math.sin(1.3 * k * DT), 0.2 * math.cos(2.1 * k * DT)])
        explained.note(DT, stiffness, swing + 5.0, size * swing - 3.0)
    assert explained.share == pytest.approx(max(1.0 - size**2, 0.0), abs=0.01)
