# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The paper's experiment: both forms agree, lengths are constant, plants lean with the wind."""

from __future__ import annotations

import numpy as np
import pytest
from tree_sway_lab.paper import experiment as experiment_module
from tree_sway_lab.paper.experiment import FORMS, RATE, run_experiment, wind_from_the_right
from tree_sway_lab.paper.followers import followed
from tree_sway_lab.paper.pictures import tip_path

from tree_sway.commands import cli
from tree_sway.core.species.species import species_named
from tree_sway.errors import ParameterError

SHOWN = []
"""What there was a bar for."""


@pytest.fixture(scope='module')
def experiment(fork):
    def shown(items, what):
        SHOWN.append(what)
        return items

    speed = wind_from_the_right(4.0, 1.0)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(experiment_module, 'bar', shown)
        return run_experiment(fork(), species_named('broadleaf'), speed, 2e4, 200.0)


@pytest.mark.long  # each form compiles kernels of its own
def test_every_part_of_it_shows_how_far_it_is(experiment):
    assert SHOWN == [*FORMS, 'the default model']


@pytest.mark.long
def test_multipliers_and_the_reduced_form_agree(experiment):
    found = experiment.solutions
    reduced = found['reduced']
    assert np.degrees(np.abs(reduced.angle).max()) > 1.0, 'it moves'
    assert np.abs(found['multipliers'].angle - reduced.angle).max() < 1e-5
    assert np.abs(found['propagator'].angle - reduced.angle).max() < 5e-3
    scale = np.abs(reduced.reaction).max()
    assert np.abs(found['multipliers'].reaction - reduced.reaction).max() < 1e-5 * scale
    assert found['multipliers'].operations > 3 * reduced.operations
    assert len(found['reduced'].angle) == len(experiment.speed) == RATE + 1
    assert set(found) == set(FORMS)


@pytest.mark.long
def test_followers_keep_lengths_and_joints(experiment):
    tree = experiment.tree
    start, end = followed(tree, experiment.keys, experiment.solutions['reduced'].angle[-1])
    assert np.linalg.norm(end - start, axis=1) == pytest.approx(tree.length, rel=1e-12)
    assert start[0] == pytest.approx(tree.start[0])
    still, _ = followed(tree, experiment.keys, np.zeros(tree.n_branches))
    assert still == pytest.approx(tree.start, abs=1e-12)


@pytest.mark.long
def test_a_wind_from_the_right_bends_the_plant_to_the_west(experiment):
    path = tip_path(experiment, experiment.solutions['reduced'].angle[-1:])
    assert path[0, 0] < 0.0


def test_the_command_refuses_what_the_paper_has_not(capsys):
    assert cli.main(['lab', 'paper', 'oak']) == 2
    assert 'benjamina or goldcrest' in capsys.readouterr().err


@pytest.mark.long
def test_an_unstable_form_is_named(fork):
    speed = wind_from_the_right(4.0, 0.5)
    with pytest.raises(ParameterError, match="'baumgarte' is unstable at 240 steps per second"):
        run_experiment(fork(), species_named('broadleaf'), speed, 1e8, 200.0)
