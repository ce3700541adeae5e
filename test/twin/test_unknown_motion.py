# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The law of the motion that the wind does not tell."""

from __future__ import annotations

import numpy as np

from tree_sway.core.scene.make import make_simulator
from tree_sway.core.species.species import species_named
from tree_sway.growth.growing import grow
from tree_sway.twin.unknown_motion import UnknownMotion


def test_unknown_forces_are_of_the_size_that_sensors_tell() -> None:
    tree = grow('spruce', 2.0, rng=np.random.default_rng(8))
    simulator = make_simulator(tree, species_named('spruce'), in_leaf=False, model=20)
    unknown = UnknownMotion(simulator, 4, 1.0 / 60.0)
    unknown.note_wind(7.0)
    usual = unknown.find()
    felt = np.eye(2, 12)
    expected = float(np.trace(unknown.variance[:2, :2]))
    unknown.size = unknown.told_size(0.64 * expected, felt)
    assert not unknown.is_outdated  # of nearly the same size
    unknown.size = unknown.told_size(0.16 * expected, felt)
    assert unknown.is_outdated
    np.testing.assert_allclose(unknown.find().driven, 0.4 * usual.driven)
    assert not unknown.is_outdated
    np.testing.assert_allclose(unknown.told_size(0.16 * expected, felt), 0.4)
    assert unknown.told_size(1e6 * expected, felt) == 1.5
