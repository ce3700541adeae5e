# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Bands of used strength hold 80 % of trees whose strength and load are drawn at random."""

from __future__ import annotations

import numpy as np
import pytest

from tree_sway.simulation.strength_band import load_band, root_band, wood_band


def drawn(rng, *deviations, n=200_000):
    """Log-normal factors about 1, (n,)."""
    return np.exp(rng.normal(size=(n, len(deviations))) @ np.array(deviations))


@pytest.mark.parametrize('in_leaf', [True, False])
def test_four_trees_of_five_are_within_the_band(in_leaf):
    """Factors as their sources have them, drawn one by one."""
    rng = np.random.default_rng(4)
    load = drawn(rng, 0.25, 0.3, *([0.35] if in_leaf else []))
    clear, roots = drawn(rng, 0.16), drawn(rng, 0.33, 0.27)
    knots = 1.0 - rng.uniform(0.0, 0.15, len(load))
    for share, band in (
        (load, load_band(in_leaf=in_leaf)),
        (load / (clear * knots), wood_band(in_leaf=in_leaf)),
        (load / roots, root_band(in_leaf=in_leaf)),
    ):
        middle, low, high = band
        assert middle == 1.0
        assert np.mean(share < low) == pytest.approx(0.1, abs=0.005)
        assert np.mean(share > high) == pytest.approx(0.1, abs=0.005)
