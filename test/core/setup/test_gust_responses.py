# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Coordinates by what turbulence does: the air's damping in them, and what few of them hold."""

from __future__ import annotations

import numpy as np
import pytest
from tree_sway_lab.bench.sizes import gusts_and_turns
from tree_sway_lab.kinds.kinds import kind_called

from tree_sway.core.scene.make import make_simulator
from tree_sway.core.setup.gust_responses import gust_slopes
from tree_sway.core.setup.reductions import TreeReductions
from tree_sway.core.setup.tree_motion import tip_motion

DT = 1.0 / 60.0


@pytest.fixture(scope='module')
def spire():
    """Return all coordinates of a conifer whose whorls swing alike."""
    return make_simulator(kind_called('spire'), model='full', damping_ratio=0.05)


@pytest.fixture(scope='module')
def reduced(spire):
    """Return its reductions."""
    return TreeReductions(spire.tree, spire.models[0].species, spire.settings)


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


@pytest.mark.parametrize(('count', 'most'), [(20, 0.6), (60, 0.6)])
def test_as_many_coordinates_hold_more_of_the_motion_than_natural_modes(
    spire, reduced, count, most
):
    """What the tips of all coordinates do in turbulence, and how much of it lies in some."""
    spire.reset()
    turns = []
    for blowing in gusts_and_turns(3.0, 300, seed=7):
        spire.step(blowing, DT)
        turns.append(spire.rotations().copy())
    turns, reductions = np.array(turns[60:]).T, reduced
    mass, branches = reductions.with_subtrees.reduction.mass, reductions.with_subtrees.branches

    def left_out(shapes):
        missed = (
            turns
            - shapes
            @ np.linalg.lstsq(shapes.T @ (mass @ shapes), shapes.T @ (mass @ turns), rcond=None)[0]
        )
        return np.linalg.norm(tip_motion(branches, missed))

    chosen, natural = reductions.modes(count).shapes, reductions.natural_modes(count).shapes
    assert chosen.shape == natural.shape
    assert left_out(chosen) < most * left_out(natural)
