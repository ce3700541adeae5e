# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Limbs share the gusts that move a tree: slow ones of a stiff crown, else those of its swing."""

from __future__ import annotations

import numpy as np
import pytest

from tree_sway.core.wind.gusts import DECAY
from tree_sway.twin.disturbance import shared_gusts

BETWEEN = np.array([[0.0, 1.5], [1.5, 0.0]])
SPEED = 7.0


def test_a_limb_shares_all_with_itself_and_less_with_farther_ones() -> None:
    found = shared_gusts(BETWEEN, SPEED, 1.0, 0.05)
    np.testing.assert_allclose(np.diag(found), 1.0)
    assert 0.0 < shared_gusts(2.0 * BETWEEN, SPEED, 1.0, 0.05)[0, 1] < found[0, 1] < 1.0


def test_a_tree_that_hardly_loses_swings_by_the_gusts_of_its_frequency() -> None:
    at_first = np.exp(-DECAY * 1.0 / SPEED * 1.5)
    assert shared_gusts(BETWEEN, SPEED, 1.0, 1e-6)[0, 1] == pytest.approx(at_first, rel=0.01)


def test_a_damped_tree_leans_and_its_limbs_share_more() -> None:
    found = [shared_gusts(BETWEEN, SPEED, 2.0, each)[0, 1] for each in (0.01, 0.05, 0.2)]
    assert found == sorted(found)
    assert found[-1] > 4.0 * np.exp(-DECAY * 2.0 / SPEED * 1.5)
