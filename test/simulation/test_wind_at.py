# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The wind at a place: of a tree that stands there, by the profile, without a history."""

from __future__ import annotations

import numpy as np
import pytest

from tree_sway.core.scene.make import make_simulator
from tree_sway.core.scene.placed_tree import PlacedTree
from tree_sway.core.scene.scene import Scene
from tree_sway.core.species.species import species_named
from tree_sway.core.wind.gusts.gust_travel import GustHistory
from tree_sway.core.wind.height_profile import WindProfile
from tree_sway.errors import ParameterError
from tree_sway.simulation.local_wind import wind_at

DT = 1.0 / 60.0


def test_a_place_has_the_wind_of_a_tree_that_stands_there() -> None:
    places = [[0.0, 0.0, 0.0], [30.0, 12.0, 0.0], [-9.0, 40.0, 0.0]]
    for anemometer in (None, (-20.0, 0.0, 0.0)):
        history = GustHistory(places, anemometer)
        rng = np.random.default_rng(2)
        wind = np.array([8.0, 2.0, 0.0])
        for _ in range(3600):
            wind += 0.05 * (np.array([8.0, 2.0, 0.0]) - wind) + 0.1 * rng.standard_normal(3)
            there = history.push(wind, DT).copy()
        for place, expected in zip(places, there, strict=True):
            found = history.wind_at(place[0], place[1])
            np.testing.assert_allclose(found, expected, atol=0.25)
    assert not np.allclose(there[0], there[1], atol=0.3)


def test_a_front_reaches_a_place_after_its_way() -> None:
    """A step of the wind from 5 m/s, at 40 m after 8 s."""
    history = GustHistory([[0.0, 0.0, 0.0]], (0.0, 0.0, 0.0), averaging_time=3600.0)
    for _ in range(3600):
        history.push((5.0, 0.0, 0.0), DT)
    arrived = None
    for step in range(600):
        history.push((9.0, 0.0, 0.0), DT)
        if arrived is None and history.wind_at(40.0, 0.0)[0] > 7.0:
            arrived = step * DT
    assert arrived == pytest.approx(8.0, rel=0.1)


def test_before_any_wind_it_is_calm() -> None:
    assert GustHistory([[0.0, 0.0, 0.0]]).wind_at(3.0, 4.0).tolist() == [0.0, 0.0, 0.0]


def test_height_follows_the_profile(fork) -> None:
    profile = WindProfile('log', 10.0, roughness=0.03)
    tree = fork()
    one = make_simulator(tree, species_named(tree.species), model=4, profile=profile)
    two = Scene(
        [PlacedTree(name, tree, x=x) for name, x in (('a', 0.0), ('b', 5.0))], 'two', 'two'
    ).simulator(model=4, profile=profile)
    for simulator in (one, two):
        for _ in range(30):
            simulator.step((6.0, 0.0, 0.0), DT)
        at_10, at_2 = (wind_at(simulator, (0.0, 0.0, z)) for z in (10.0, 2.0))
        assert at_10[0] == pytest.approx(6.0)
        assert at_2[0] == pytest.approx(6.0 * np.log(2.0 / 0.03) / np.log(10.0 / 0.03))
        assert wind_at(simulator, (0.0, 0.0, -1.0))[0] == 0.0


def test_a_place_that_is_none_is_refused(fork) -> None:
    tree = fork()
    simulator = make_simulator(tree, species_named(tree.species), model=4)
    with pytest.raises(ParameterError, match='is no place'):
        wind_at(simulator, (0.0, np.nan, 0.0))
