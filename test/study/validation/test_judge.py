# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Models against every segment solved on random crooked trees, with weight and twist."""

from __future__ import annotations

import numpy as np
import pytest

from tree_sway_ros.study.validation.crooked_trees import crooked_tree, HABITS
from tree_sway_ros.study.validation.judge import Judge, SWAYS
from tree_sway_ros.study.validation.winds import FRAME, from_record, hard_cases, turbulent


@pytest.mark.parametrize('seed', range(1, 7))
def test_trees_are_crooked_unlike_and_of_the_size_promised(seed):
    tree = crooked_tree(seed)
    assert 40 <= tree.n_branches <= 120
    assert tree.name.startswith(tuple(HABITS)[seed % 3])
    np.testing.assert_array_equal(tree.end, crooked_tree(seed).end)
    bent = [
        np.linalg.norm(tree.end[here][-1] - tree.start[here][0]) / tree.length[here].sum()
        for here in map(tree.segments_of, range(tree.n_branches))
    ]
    assert min(bent) < 0.97
    assert len(set(np.round(tree.branch_length, 6))) == tree.n_branches


def test_winds_are_as_their_names_say():
    cases = hard_cases(10.0, 0.8)
    assert set(cases) == {'gust', 'step', 'sine', 'turn'}
    assert all(wind.shape == (600, 3) for wind in cases.values())
    speed = np.linalg.norm(cases['step'], axis=1)
    assert speed.min() == 0.0
    assert speed.max() == pytest.approx(10.0)
    first, last = cases['turn'][0, :2], cases['turn'][-1, :2]
    assert first @ last == pytest.approx(0.0, abs=1e-9)
    assert np.linalg.norm(turbulent(9.0, 20.0, 1), axis=1).mean() == pytest.approx(9.0, rel=0.15)
    time = np.arange(0.0, 30.0, 0.05)
    calm_then_windy = np.where(time[:, None] > 20.0, 5.0, 1.0) * np.array([1.0, 0.0, 0.0])
    assert from_record(time, calm_then_windy, 5.0, 2.0)[:, 0] == pytest.approx(10.0)


@pytest.fixture(scope='module')
def judge():
    return Judge(crooked_tree(9), pieces=2, substeps=4)


def test_models_stay_within_their_errors_and_estimates(judge):
    winds = {'simulated': turbulent(9.0, 4.0, 9)}
    winds['sine'] = hard_cases(4.0, judge.first_frequency)['sine']
    verdicts = judge.verdicts(winds)
    by_name = {(one.wind, one.model): one.error for one in verdicts}
    assert by_name['simulated', 'coupled'] <= 0.03
    assert by_name['simulated', 'modes 12'] <= 0.05
    over = [one.over_estimate for one in verdicts if np.isfinite(one.over_estimate)]
    assert max(over) <= 1.0
    assert np.median(over) >= 0.3
    assert len(winds['sine']) * FRAME == pytest.approx(4.0)


def test_steady_sway_is_the_truths(judge):
    assert (np.abs(judge.steady_sway(sways=SWAYS[:2])) <= (0.02, 0.04)).all()


def missing(seed, reason):
    return pytest.param(seed, marks=pytest.mark.xfail(strict=True, reason=reason))


@pytest.mark.long
@pytest.mark.parametrize(
    'seed',
    [
        1, 2, 9, 20, 22,
        missing(
            11, 'a stiff arching tree: coupled errs by 0.031 in 3 m/s for the twist of its long '
            'twigs, and it takes 135 m/s to lean it by 30 %'
        ),
        missing(
            47, 'an arching tree: coupled errs by 0.043 in 3 m/s, by 0.039 with further shapes in '
            'every branch; some twigs stand off by 6 % more than the truth in the mean'
        ),
    ],
)  # fmt: skip
def test_models_err_and_sway_within_their_limits_on_random_trees(seed):
    judge = Judge(crooked_tree(seed))
    winds = {f'{mean:g}': turbulent(mean, 8.0, seed) for mean in (3.0, 9.0)}
    for one in judge.verdicts(winds, ['modes 12', 'coupled']):
        assert one.error <= (0.03 if one.model == 'coupled' else 0.05), one
        assert one.over_estimate <= 1.0, one
    assert (np.abs(judge.steady_sway()) <= (0.02, 0.04, 0.08)).all()
