# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Every model of a tree behind one face, and every segment solved as one of them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import drawn_trees
import numpy as np
import pytest
from simulators import MODELS

from tree_sway.core.scene.make import make_simulator
from tree_sway.core.settings import Settings
from tree_sway.core.setup.preparation import prepare
from tree_sway.core.species.species import Species, species_named
from tree_sway.core.wind.height_profile import WindProfile
from tree_sway.errors import ParameterError

ROOT = Path(__file__).resolve().parents[3]
DT = 1.0 / 60.0
WOOD = Species('example', 'example', 8e9, 900.0, damping_bare=0.1)


@pytest.fixture(scope='module')
def stem():
    return drawn_trees.stem(4.0, 0.06, 0.03, 12)


@pytest.mark.parametrize('model', [0, 3, 60, *MODELS])
def test_every_model_leans_with_the_wind_and_goes_back_to_rest(stem, model):
    sim = make_simulator(stem, WOOD, model=model, tolerance=1e-4)
    rest = sim.place().copy()
    for _ in range(240):
        assert sim.step((8.0, 0.0, 0.0), DT) == 0
    sim.place()
    if model != 0:
        assert sim.tip_displacement[0] > 0.01
        assert abs(sim.tip_displacement[1]) < 1e-9
    assert sim.step((np.inf, 0.0, 0.0), DT) == 1
    assert sim.counts.refused == 1
    sim.reset()
    np.testing.assert_allclose(sim.place(), rest, atol=1e-12)


@pytest.mark.parametrize('model', [20, *MODELS])
def test_a_limb_below_the_ground_at_the_stem_takes_no_wind(fork, model):
    """So hang limbs of trees on slopes, whose wind begins at the ground of their stem."""
    tree = fork()
    ground = 1.01 * tree.height
    sim = make_simulator(tree, WOOD, model=model, profile=WindProfile('log', ground=ground))
    for _ in range(60):
        sim.step((8.0, 0.0, 0.0), DT)
    sim.place()
    assert 0.0 < np.abs(sim.tip_displacement).max() < 1e-4


def test_a_stem_leans_as_far_in_every_model(stem):
    lean = {}
    for model in ('branch', 20):
        sim = make_simulator(stem, WOOD, model=model, damping_ratio=0.5)
        for _ in range(600):
            sim.step((6.0, 0.0, 0.0), DT)
        sim.place()
        lean[model] = sim.tip_displacement[0]
    for model, x in lean.items():
        assert x == pytest.approx(lean[20], rel=0.02), model


def test_what_a_model_does_not_know_is_refused(stem):
    with pytest.raises(ParameterError, match=r"unknown model 'best'.*auto"):
        make_simulator(stem, WOOD, model='best')
    with pytest.raises(ParameterError, match='volume rule'):
        make_simulator(stem, WOOD, model='full', volume_stiffness=1e5)


@pytest.mark.parametrize('model', [0, 3, 60, *MODELS])
def test_a_tree_is_used_like_a_forest_of_one(stem, model):
    sim = make_simulator(stem, WOOD, model=model)
    sim.step((3.0, 1.0, 0.0), DT)
    assert sim.simulators == (sim,)
    assert sim.gusts is None
    assert sim.wind == pytest.approx([3.0, 1.0, 0.0])


def test_one_prepared_model_is_not_auto(stem):
    with pytest.raises(ParameterError, match=r"model 'auto' .* make it by make_simulator"):
        prepare(stem, WOOD, model='auto')


def test_a_prepared_model_has_its_own_settings(stem):
    model = prepare(stem, WOOD, model=4)
    assert make_simulator(model).model == '4'
    for other in ({'model': 6}, {'settings': Settings()}, {'species': WOOD}):
        with pytest.raises(ParameterError, match=r'prepared model .* prepare the tree again'):
            make_simulator(model, **other)


def test_the_model_is_that_of_the_settings(stem):
    assert make_simulator(stem, WOOD, Settings(model='branch')).model == 'branch'
    assert make_simulator(stem, WOOD, Settings(model='branch'), model=12).model == '12'
    (model,) = make_simulator(replace(stem, species='oak')).models
    assert model.species is species_named('oak')
