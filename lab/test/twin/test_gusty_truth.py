# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The tree outside: gusts have their spectrum and coherence; in one wind it is the model's."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.signal import coherence
from tree_sway_lab.twin.gust_field import GustField, OtherField, spread_points
from tree_sway_lab.twin.gusty_truth import gusty_motion, mast_of, Outside
from tree_sway_lab.twin.trial import plain_score
from tree_sway_lab.twin.true_tree import tree_called

from tree_sway.core.scene import make_simulator
from tree_sway.core.setup import one_thread

RATE = 10.0
PLACES = np.array([[0.0, 0.0, 10.0], [0.0, 5.0, 10.0], [20.0, 0.0, 10.0]])


def test_gusts_have_the_deviation_and_coherence_that_are_asked_for() -> None:
    field = GustField(PLACES, intensity=0.2)
    wind = field.record(3000.0, RATE, np.random.default_rng(3))
    np.testing.assert_allclose(wind.mean(axis=(0, 1)), [7.0, 0.0, 0.0], atol=1e-9)
    np.testing.assert_allclose(wind.std(axis=0), 3 * [[1.4, 1.12, 0.7]], rtol=0.03)
    frequency, found = coherence(wind[:, 0, 0], wind[:, 1, 0], RATE, nperseg=1024)
    rows = (frequency > 0.02) & (frequency < 0.15)
    wanted = np.exp(-2.0 * 10.0 * 5.0 / 7.0 * frequency[rows])
    np.testing.assert_allclose(found[rows], wanted, atol=0.15)


def test_gusts_travel_with_the_mean_wind() -> None:
    wind = GustField(PLACES).record(600.0, RATE, np.random.default_rng(4))[:, :, 0] - 7.0
    lags = np.arange(60)
    alike = [np.mean(wind[:5900, 0] * wind[lag : 5900 + lag, 2]) for lag in lags]
    assert lags[int(np.argmax(alike))] / RATE == pytest.approx(20.0 / 7.0, abs=0.4)


def test_other_gusts_go_another_way_and_are_weaker_near_the_ground() -> None:
    places = np.array([[0.0, 0.0, 10.0], [0.0, 0.0, 1.0]])
    field = OtherField(places, intensity=0.2, heading=np.deg2rad(120.0))
    wind = field.record(3000.0, RATE, np.random.default_rng(6))
    mean = wind.mean(axis=0)
    wanted = 7.0 * np.outer([1.0, 0.1**0.2], [-0.5, np.sqrt(0.75), 0.0])
    np.testing.assert_allclose(mean, wanted, atol=1e-9)
    along = (wind - mean)[:, 0] @ wanted[0] / 7.0
    assert along.std() == pytest.approx(1.4, rel=0.03)
    fast = np.array([2.0])
    kaimal = GustField(places, intensity=0.2).spectrum(fast)
    assert field.spectrum(fast)[0, 0] == pytest.approx(0.57 * kaimal[0, 0], rel=0.05)


def test_a_mast_upwind_stands_where_the_wind_comes_from() -> None:
    westerly = mast_of(Outside(mast=(-12.0, 0.0, 0.0)))
    southerly = mast_of(Outside(mast=(-12.0, 0.0, 0.0), heading=0.5 * np.pi))
    assert np.rad2deg(westerly[1]) % 360.0 == pytest.approx(270.0)
    assert np.rad2deg(southerly[1]) % 360.0 == pytest.approx(180.0)


def test_points_represent_what_they_stand_for() -> None:
    places = np.random.default_rng(5).normal(size=(500, 3))
    points = spread_points(places, np.ones(500), 12)
    assert len(points) == 12
    assert np.linalg.norm(points.mean(axis=0)) < 0.3


def test_in_one_wind_a_tree_of_the_same_wood_is_the_models() -> None:
    tree, species = tree_called('crooked 4')
    with one_thread():
        true = gusty_motion(
            tree, species, [], Outside(seconds=30.0, is_uniform=True), in_leaf=False
        )
        score = plain_score(make_simulator(tree, species, in_leaf=False), true)
    print(score)
    assert score.error < 0.1
    assert score.stem > 0.99
