# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Scores of trees with sensors: known ones in closed form, and a short trial."""

from __future__ import annotations

import csv
from dataclasses import replace
import math

import numpy as np
import pytest
from scipy.signal import butter, sosfilt
from tree_sway_lab.twin.trial import _compared, _held, DT, linear_score, squared_score
from tree_sway_lab.twin.true_tree import (
    Circumstances,
    drawn,
    sensor_places,
    tree_called,
    true_motion,
    TrueMotion,
)

from tree_sway.commands.cli import main
from tree_sway.twin.observed_tree import ObservedTree

TIME = DT * np.arange(3000)
TIPS = np.stack([np.sin(TIME), np.cos(1.3 * TIME), 0.0 * TIME], axis=1)[:, None]


def test_the_truth_has_no_error() -> None:
    assert _compared(TIPS, TIPS) == pytest.approx((0.0, 1.0, 1.0))


def test_error_is_of_the_motion_and_not_of_its_mean() -> None:
    error, rough, stem = _compared(0.9 * TIPS + 5.0, TIPS)
    assert (error, rough, stem) == pytest.approx((0.1, 0.9, 1.0), abs=1e-9)


def test_a_late_motion_has_an_error() -> None:
    late = np.roll(TIPS, 6, axis=0)
    assert _compared(late, TIPS)[0] > 0.05


def test_a_band_holds_its_share_of_normal_errors() -> None:
    wrong = np.random.default_rng(5).normal(0.0, 0.2, (20_000, 2, 3))
    half = np.full_like(wrong, 1.2816 * 0.2)
    band = np.stack([-half, half], axis=1)
    assert _held(wrong, np.zeros_like(wrong), band) == pytest.approx(0.8, abs=0.01)


def test_a_linear_filter_finds_what_sensors_tell_and_nothing_else() -> None:
    rng = np.random.default_rng(9)
    low = butter(2, 1.0, fs=1.0 / DT, output='sos')
    sway = sosfilt(low, 0.1 * rng.normal(size=(12_000, 4)), axis=0)
    told, untold = sway[:, None, :2], sway[:, None, 2:]
    flat = np.zeros((len(sway), 1))
    # It tilts, and gravity tells by how much.
    poses = np.hstack([flat, flat, flat, told[:, 0], flat, flat + 1.0])
    for moved, least, most in ((3.0 * told, 0.0, 0.3), (untold, 0.95, 1.1)):
        tips = np.concatenate([moved, flat[:, None]], axis=2)
        true = TrueMotion(rng.normal(size=(len(sway), 3)), tips, {'stem': poses})
        assert least < linear_score(true, ['stem']).error < most


def test_the_square_of_the_wind_explains_a_motion_that_is_one() -> None:
    wind = np.zeros((len(TIME), 3))
    wind[:, 0] = 5.0 + np.sin(TIME)
    wind[:, 1] = np.cos(1.3 * TIME)
    keep = float(np.exp(-2.0 * np.pi * 0.5 * DT))
    tips, passed = np.empty((len(TIME), 1, 3)), np.zeros(3)
    for k, each in enumerate(wind):
        passed = keep * passed + (1.0 - keep) * np.linalg.norm(each) * each
        tips[k, 0] = 0.01 * passed
    tips[:, 0, 2] = 0.0
    true = TrueMotion(wind, tips, {})
    assert squared_score(true, 0.5).error < 1e-9
    # The gains of a tree that moves half as far leave half of the motion.
    assert squared_score(true, 0.5, 0.5 * tips).error == pytest.approx(0.5)


def test_drawn_trees_have_the_spreads_of_wood_damping_and_drag() -> None:
    trees = drawn(Circumstances(), 400, in_leaf=False)
    logs = np.log([(each.wood, each.damping, each.drag) for each in trees])
    np.testing.assert_allclose(logs.mean(axis=0), 0.0, atol=1e-3)
    np.testing.assert_allclose(logs.std(axis=0), [0.22, 0.5, 0.25], rtol=0.01)
    assert np.abs(np.corrcoef(logs.T) - np.eye(3)).max() < 0.2
    assert len({each.seed for each in trees}) == 400


def test_a_band_of_the_lean_holds_its_share_of_few_drawn_trees() -> None:
    held = []
    for seed in range(200):
        for each in drawn(Circumstances(seed=seed), 4, in_leaf=False):
            held.append(abs(math.log(each.drag / each.wood)) < 1.2816 * math.hypot(0.25, 0.22))
    assert np.mean(held) == pytest.approx(0.8, abs=0.03)


def test_a_true_tree_of_more_drag_leans_more() -> None:
    tree, species = tree_called('straight')
    calm = Circumstances(coherence=1.0, speed=4.0, seconds=25.0)
    lean = []
    for drag in (1e-6, 1.0, 1.5):
        around = replace(calm, drag=drag)
        true = true_motion(tree, species, [], around, in_leaf=False, model=30)
        lean.append(true.tips[600:, 0, 0].mean())
    assert (lean[2] - lean[0]) / (lean[1] - lean[0]) == pytest.approx(1.5, abs=0.05)


def test_sensors_sit_on_the_stem_and_then_on_the_stoutest_limbs() -> None:
    tree, _ = tree_called('straight')
    places = sensor_places(tree, 4)
    assert len(set(places)) == 4
    assert places[0] == f'{tree.branch_names[0]}:0.6'


@pytest.mark.long  # `test/twin/test_observed_tree.py` has this law in every run
def test_one_sensor_takes_away_most_of_the_error(capsys: pytest.CaptureFixture[str]) -> None:
    words = 'lab twin --easy --model 90 --seconds 45 --sensors 1 --'.split()
    assert main([*words, 'spruce 4 6']) == 0
    rows = list(csv.DictReader(capsys.readouterr().out.splitlines()))
    errors = {row['sensors']: float(row['error']) for row in rows}
    assert list(errors) == ['U^2', 'model', '1 linear', '1']
    assert errors['1'] < 0.6 * min(errors['model'], errors['U^2'])


def test_a_sensor_finds_how_late_gusts_are_that_are_measured_upwind(
    capsys: pytest.CaptureFixture[str],
) -> None:
    words = 'lab twin --easy --model 90 --seconds 45 --upwind 30 --without-band'.split()
    assert main([*words, '--sensors', '0', '1', '--', 'spruce 4 6']) == 0
    rows = list(csv.DictReader(capsys.readouterr().out.splitlines()))
    errors = {row['sensors']: float(row['error']) for row in rows}
    assert errors['1'] < 0.4 * errors['0']
    assert 'moves 4.' in rows[-1]['notes']


def test_a_model_that_knows_the_tree_errs_less(capsys: pytest.CaptureFixture[str]) -> None:
    words = 'lab twin --easy --model 90 --seconds 30 --sensors 0 --without-band'.split()
    errors = []
    for more in ([], ['--known', '--advised']):
        assert main([*words, *more, '--', 'spruce 4 6']) == 0
        *_, last = csv.DictReader(capsys.readouterr().out.splitlines())
        errors.append(float(last['error']))
    assert errors[1] < 0.8 * errors[0]


def test_a_told_distance_of_the_anemometer_is_for_a_tree_without_sensors() -> None:
    tree, species = tree_called('straight')
    told = [
        ObservedTree(tree, species, model=30, in_leaf=False, at=at, upwind=30.0)
        for at in ({}, {'phone': 1.0})
    ]
    for each in told:
        each.step((5.0, 0.0, 0.0), DT)
    assert [each.late_wind.delay for each in told] == pytest.approx([6.0, 0.0])


@pytest.mark.long
def test_a_sensor_on_a_limb_tells_one_period_of_sway_from_the_next(
    capsys: pytest.CaptureFixture[str],
) -> None:
    words = 'lab twin crooked --easy --model 120 --seconds 60 --sensors 1 --seed 415'.split()
    assert main([*words, '--upwind', '30', '--advised', '--without-band']) == 0
    *_, last = csv.DictReader(capsys.readouterr().out.splitlines())
    assert 'moves 4.' in last['notes']
