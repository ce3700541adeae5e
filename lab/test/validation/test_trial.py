# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Trials on kinds of trees: the kinds, the winds, the three measures, truths cached on disk."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tree_sway_lab.commands import COMMANDS
from tree_sway_lab.kinds.kinds import HANGING, kind_called, KINDS
from tree_sway_lab.tip_error import roughness
from tree_sway_lab.validation import truth
from tree_sway_lab.validation.trial import has_mujoco, judged_simulator, MUJOCO, tried
from tree_sway_lab.validation.truth import Fineness, QUICK, true_frequencies, true_tips
from tree_sway_lab.validation.winds import FRAME, STEP_FRAME, wind_called

from tree_sway.commands.cli import main
from tree_sway.errors import ParameterError


@pytest.mark.parametrize('kind', [kind for kind in KINDS if kind not in ('crooked', 'straight')])
def test_kinds_are_drawn_from_their_seed_and_stand(kind: str) -> None:
    tree = kind_called(kind)
    np.testing.assert_array_equal(tree.end, kind_called(f'{kind} 1').end)
    assert not np.array_equal(tree.end, kind_called(f'{kind} 2').end)
    assert tree.end[:, 2].min() > 0.0
    assert true_frequencies(tree, 1, Fineness(1, 1))[0] > 0.1


@pytest.mark.parametrize('kind', HANGING)
def test_twigs_hang(kind: str) -> None:
    tree = kind_called(kind)
    ends = tree.end[tree.branch_first[1:] - 1]
    bases = tree.start[tree.branch_first[:-1]]
    thin = tree.base_diameter[tree.branch_first[:-1]] <= 0.005
    assert thin.sum() >= 40
    assert (bases[thin, 2] - ends[thin, 2] > 0.8).all()


def test_winds_are_as_they_are_called() -> None:
    step = np.linalg.norm(wind_called('step', 6.0), axis=1)
    assert step[120:STEP_FRAME] == pytest.approx(5.0)
    assert step[STEP_FRAME] == pytest.approx(10.0)
    seconds = wind_called('seconds', 3.0)
    assert len(np.unique(seconds[:, 0])) == 3
    up = wind_called('up', 6.0).mean(axis=0)
    assert up[2] > 4.0 * np.linalg.norm(up[:2])
    turned = wind_called('reversal', 6.0)
    assert np.linalg.norm(np.diff(turned, axis=0), axis=1).max() < 0.3
    np.testing.assert_allclose(turned[0], -turned[-1], rtol=0.05)
    assert np.linalg.norm(wind_called('15', 6.0), axis=1).mean() == pytest.approx(15.0, rel=0.3)
    with pytest.raises(ParameterError, match="no wind 'gale'"):
        wind_called('gale', 6.0)


def test_the_three_measures_see_what_each_is_for() -> None:
    t = FRAME * np.arange(300)
    truth_tips = np.zeros((300, 1, 3))
    truth_tips[:, 0, 0] = 0.1 * np.sin(2.0 * np.pi * t)
    shaken = truth_tips.copy()
    shaken[:, 0, 0] += 0.002 * (-1.0) ** np.arange(300)
    assert roughness(truth_tips, truth_tips) == 1.0
    assert roughness(shaken, truth_tips) > 5.0


def test_a_truth_is_computed_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(truth, 'cache_folder', lambda: tmp_path)
    tree, wind = kind_called('limbs2'), wind_called('step', 1.0)[:3]
    first = true_tips(tree, wind, QUICK)
    monkeypatch.setattr(truth, 'record_tips', None)
    np.testing.assert_array_equal(first, true_tips(tree, wind, QUICK))
    with pytest.raises(TypeError):
        true_tips(tree, 2.0 * wind, QUICK)


def test_models_are_called_by_number_or_by_name() -> None:
    tree = kind_called('limbs8')
    assert judged_simulator('branch', tree).model == 'branch'
    assert judged_simulator('default', tree).model
    with pytest.raises(ParameterError, match='modes twelve'):
        judged_simulator('modes twelve', tree)


def test_all_coordinates_are_near_the_truth_on_a_stem_with_limbs() -> None:
    trial = tried('limbs8', '9', 'full', QUICK)
    assert trial.error < 0.04
    assert 0.8 < trial.roughness < 1.2
    assert np.isnan(trial.jump)


def test_the_command_prints_trials(capsys: pytest.CaptureFixture[str]) -> None:
    example = COMMANDS['validate'].example.split()
    assert main(['lab', *example]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].startswith('| tree | wind | model | error | roughness |')
    beside = ['MuJoCo'] if has_mujoco() else []
    assert [line.split(' | ')[2] for line in lines[2:]] == [*beside, 'default', 'full']


def test_mujoco_is_tried_in_the_same_wind() -> None:
    pytest.importorskip('mujoco')
    trial = tried('limbs8', '9', MUJOCO, QUICK)
    print(f'error {trial.error:.3f}, {trial.cost:.0f} us a frame')
    assert trial.error < 0.2
    assert trial.cost > 0.0
