# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Coordinates by what turbulence does: its load on them, and the air's damping in them."""

from __future__ import annotations

from drawn_trees import crown, SETTINGS, WOOD
import numpy as np
import pytest

from tree_sway.core.setup.gust_responses import gust_slopes
from tree_sway.core.setup.reductions import TreeReductions


@pytest.fixture(scope='module')
def reduced():
    return TreeReductions(crown(), WOOD, SETTINGS)


@pytest.mark.parametrize('azimuth', [0.3, 2.0])
def test_slopes_are_those_of_the_load(reduced, azimuth):
    reductions, size = reduced, 1e-3
    moments, shapes = reductions.wind_moments, reductions.natural_modes(20).shapes
    still, ahead = np.zeros(len(shapes)), np.array([np.cos(azimuth), np.sin(azimuth), 0.0])
    ((load, air),) = gust_slopes(reductions.with_subtrees.branches, shapes, ahead)
    by_wind = [moments(still, still, ahead + size * e) - moments(still, still, ahead - size * e)
               for e in np.eye(3)]  # fmt: skip
    by_rate = [moments(still, size * e, ahead) - moments(still, -size * e, ahead)
               for e in shapes.T]  # fmt: skip
    assert load == pytest.approx(shapes.T @ np.array(by_wind).T / (2.0 * size), rel=1e-4, abs=1e-6)
    numeric = -shapes.T @ np.array(by_rate).T / (2.0 * size)
    assert np.linalg.norm(air - numeric) < 0.01 * np.linalg.norm(numeric)
