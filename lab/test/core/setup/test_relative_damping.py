# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Hanging twigs are damped as those of segments that are solved."""

import numpy as np
import pytest
from tree_sway_lab.kinds.kinds import kind_called
from tree_sway_lab.segments.articulated_modes import joint_modes, joint_stiffness
from tree_sway_lab.validation.truth import (
    DAMPING_RATIO,
    GRAVITY,
    QUICK,
    SETTINGS,
    true_model,
    WOOD,
)

from tree_sway.core.setup.damping import relative_damping
from tree_sway.core.setup.reductions import TreeReductions


def modal_damping_of_segments(tree, count):
    """
    Frequencies [Hz] and damping ratios of the modes of a tree of segments, (count,).

    The dampers are those of `Laws`: on all springs, and on single modes.
    """
    model = true_model(tree, QUICK)
    modes, laws = joint_modes(model.bodies, GRAVITY, count), model.laws
    turns = modes.turn.reshape(count, -1)
    by_springs = np.einsum('ki,ki->k', turns, (joint_stiffness(model.bodies, 0.0) @ turns.T).T)
    damping = laws.stiffness_damping * by_springs
    momenta = laws.mode_momentum.reshape(len(laws.mode_damping), -1)
    damping += np.square(turns @ momenta.T) @ laws.mode_damping
    return modes.frequency, damping / (4.0 * np.pi * modes.frequency)


@pytest.mark.parametrize(('kind', 'most'), [('willow', 0.3), ('birch', 0.7)])
def test_hanging_twigs_are_damped_as_those_of_segments(kind, most):
    tree, count = kind_called(kind), 60
    reductions = TreeReductions(tree, WOOD, SETTINGS)
    modes = reductions.natural_modes(count)
    found = relative_damping(reductions, modes)
    frequencies, ratios = modal_damping_of_segments(tree, count)
    assert modes.frequencies == pytest.approx(frequencies, rel=0.03)
    # The modes of twigs that are nearly alike mix; as groups they are the same.
    for group in (slice(2, 20), slice(20, 40), slice(40, 60)):
        truth = float(np.mean(ratios[group])) / DAMPING_RATIO
        assert truth < most, 'the weight has a large part of the stiffness of these twigs'
        assert float(np.mean(found[group])) == pytest.approx(truth, rel=0.2)
