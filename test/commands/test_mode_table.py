# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""How the axis of a mode is told to people."""

from __future__ import annotations

import numpy as np
import pytest

from tree_sway.commands.mode_table import direction_of


@pytest.mark.parametrize(
    ('axis', 'text'),
    [
        ((1.0, 0.0, 0.0), '  0.0 deg'),
        ((-1.0, 0.0, 0.0), '  0.0 deg'),
        ((0.0, -1.0, 0.0), ' 90.0 deg'),
        ((-1.0, 1.0, 0.0), '135.0 deg'),
        ((0.0, 0.0, -1.0), 'up and down'),
        ((0.0, 1.0, 1.0), ' 90.0 deg, +45 up'),
        ((0.0, -1.0, -1.0), ' 90.0 deg, +45 up'),
        ((0.0, 1.0, -1.0), ' 90.0 deg, -45 up'),
        ((1.0, 0.0, 0.1), '  0.0 deg'),
    ],
)
def test_the_sign_of_an_axis_means_nothing(axis: tuple[float, ...], text: str) -> None:
    unit = np.array(axis) / np.linalg.norm(axis)
    assert direction_of(unit) == text
