# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Damping of coordinates by the wood: that of dampers on its springs, none by the weight."""

from drawn_trees import crown, SETTINGS, WOOD
import pytest

from tree_sway.core.setup.damping import EVENLY_DAMPED, relative_damping
from tree_sway.core.setup.reductions import TreeReductions


def test_weight_that_softens_does_not_damp_more():
    """The ratio of a tree is that of its modes as they are, bent by their weight."""
    reductions = TreeReductions(crown((3, 3, 3)), WOOD, SETTINGS)
    found = relative_damping(reductions, reductions.natural_modes(EVENLY_DAMPED))
    assert found.max() <= 1.0 + 1e-9
    assert found[0] == pytest.approx(1.0, abs=1e-9)


def test_fast_modes_are_damped_in_proportion_to_their_frequency():
    reductions = TreeReductions(crown((3, 3, 3)), WOOD, SETTINGS)
    modes = reductions.natural_modes(EVENLY_DAMPED + 20)
    found = relative_damping(reductions, modes)
    ratio = modes.circular / modes.circular[EVENLY_DAMPED - 1]
    assert found[EVENLY_DAMPED:] == pytest.approx(ratio[EVENLY_DAMPED:], rel=0.02)
