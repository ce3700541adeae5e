# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Coordinates by what turbulence does: what few of them hold."""

from __future__ import annotations

import numpy as np
import pytest
from tree_sway_lab.bench.sizes import gusts_and_turns
from tree_sway_lab.kinds.kinds import kind_called

from tree_sway.core.scene.make import make_simulator
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
