# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What a frame holds of a tree that sways: few bytes, and whether it is beyond their range."""

from __future__ import annotations

import pytest
from simulators import turbulence

from tree_sway.core.run.simulator_basis import basis_of
from tree_sway.core.scene.make import make_simulator
from tree_sway.growth.builtin import builtin_tree
from tree_sway.stream.protocol import FRAME_SIZE, quantised

DT = 1.0 / 60.0


@pytest.fixture(scope='module')
def benjamina():
    return make_simulator(builtin_tree('benjamina'), model=60)


@pytest.fixture(scope='module')
def basis(benjamina):
    return basis_of(benjamina)


def test_a_storm_beyond_the_reported_error_is_flagged_and_a_breeze_is_not(benjamina, basis):
    for speed, is_beyond in ((6.0, False), (30.0, True)):
        flags = []
        benjamina.reset()
        for wind in turbulence(speed, 4.0, 2):
            benjamina.step(wind, DT)
            flags.append(quantised(basis.coordinates(benjamina.rotations()), basis.scale)[1])
        assert any(flags) == is_beyond


def test_a_frame_has_at_most_a_hundred_bytes(basis):
    assert FRAME_SIZE + 2 * basis.n_coordinates <= 100
