# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The model of all coordinates bends in a steady wind as its stiffness says."""

from __future__ import annotations

import pytest

from tree_sway.core.scene.make import make_simulator


def test_a_steady_wind_bends_the_coupled_tree_as_its_stiffness_says(fork):
    sim = make_simulator(fork(), model='full', gravity=0.0, damping_ratio=0.5)
    for _ in range(1500):
        sim.step([1.0, 0.4, 0.0], 1 / 30)
    bank = sim.banks[0].oscillators
    x, moment = bank.rotations(), bank.state[0]
    shapes, w2 = bank.shapes, bank.stiffness
    assert x == pytest.approx(shapes @ ((shapes.T @ moment) / w2), rel=1e-6, abs=1e-12)
