# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""No tip is flung in a gale: the model of all coordinates beside every segment solved."""

import numpy as np
import pytest
from tree_sway_lab.kinds.kinds import kind_called
from tree_sway_lab.tip_error import record_tips
from tree_sway_lab.validation.trial import judged_simulator
from tree_sway_lab.validation.truth import QUICK, true_model
from tree_sway_lab.validation.winds import FRAME, wind_called


def largest_move(tips):
    """Largest move of a tip in a frame in [m]."""
    return np.linalg.norm(np.diff(tips, axis=0), axis=2).max()


@pytest.mark.parametrize('kind', ['palm', 'shrub'])
def test_no_tip_moves_further_in_a_frame_than_with_every_segment_solved(kind):
    tree, wind = kind_called(kind), wind_called('80', 2.5)
    truth = record_tips(true_model(tree, QUICK), tree, wind, FRAME, substeps=QUICK.substeps)
    tips = record_tips(judged_simulator('full', tree), tree, wind, FRAME)
    assert largest_move(truth) > 0.5
    assert largest_move(tips) < 1.1 * largest_move(truth)


def test_twigs_that_no_step_can_follow_are_held_and_not_flung():
    tree, wind = kind_called('willow'), wind_called('80', 1.0)
    model = judged_simulator('full', tree)
    # The wind itself goes 1 m in a frame.
    assert largest_move(record_tips(model, tree, wind, FRAME)) < 2.0
    assert model.counts.clamped > 0
    assert model.counts.restarted == 0
