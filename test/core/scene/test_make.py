# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Every model of a tree behind one face, and every segment solved as one of them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tree_sway_ros.core.scene.make import make_simulator
from tree_sway_ros.core.simulator.settings import FIDELITIES, Settings
from tree_sway_ros.core.simulator.simulator import SwaySimulator
from tree_sway_ros.core.tree.species import Species, species_named
from tree_sway_ros.errors import ParameterError
from tree_sway_ros.study.example_trees import forked_tree, tapered_stem
from tree_sway_ros.study.resegment import resegment

DT = 1.0 / 60.0
WOOD = Species('example', 'example', 8e9, 900.0, damping_bare=0.1)


@pytest.fixture(scope='module')
def stem():
    return tapered_stem(4.0, np.linspace(0.06, 0.03, 13))


@pytest.mark.parametrize('fidelity', FIDELITIES)
def test_every_model_leans_with_the_wind_and_goes_back_to_rest(stem, fidelity):
    sim = make_simulator(stem, WOOD, model=fidelity, tolerance=1e-4)
    rest = sim.place().copy()
    for _ in range(240):
        assert sim.step((8.0, 0.0, 0.0), DT) == 0
    sim.place()
    if fidelity != 'frozen':
        assert sim.tip_displacement[0] > 0.01
        assert abs(sim.tip_displacement[1]) < 1e-9
    assert sim.step((np.inf, 0.0, 0.0), DT) == 1
    assert sim.counts.refused == 1
    sim.reset()
    np.testing.assert_allclose(sim.place(), rest, atol=1e-12)


def test_a_stem_leans_as_far_in_every_model(stem):
    lean = {}
    for fidelity in ('branch', 'subtree', 'coupled', 'segments'):
        sim = make_simulator(stem, WOOD, model=fidelity, damping_ratio=0.5)
        for _ in range(600):
            sim.step((6.0, 0.0, 0.0), DT)
        sim.place()
        lean[fidelity] = sim.tip_displacement[0]
    for fidelity, x in lean.items():
        assert x == pytest.approx(lean['segments'], rel=0.02), fidelity


def test_long_steps_of_every_segment_are_cut():
    tree = forked_tree(0.5, 0.6)
    one, many = (make_simulator(tree, WOOD, model='segments') for _ in range(2))
    one.step((5.0, 1.0, 0.0), 8 * DT)
    for _ in range(8):
        many.step((5.0, 1.0, 0.0), DT)
    np.testing.assert_allclose(one.place(), many.place(), atol=1e-12)


def test_what_a_model_does_not_know_is_refused(stem):
    with pytest.raises(ParameterError, match=r"unknown model 'best'.*auto"):
        make_simulator(stem, WOOD, model='best')
    with pytest.raises(ParameterError, match='volume_rule'):
        make_simulator(stem, WOOD, model='segments', stiffness='volume_rule')


def test_every_segment_bears_the_leaves_that_the_reduced_tree_does():
    """Twelve segments per branch, whose slowest sway agrees with the coupled model's, in leaf."""
    tree = resegment(forked_tree(0.5, 0.6), 12)
    wood = species_named('spruce')
    model = {'gravity': 9.81, 'damping_ratio': 0.1}
    leafy, bare = (
        [
            make_simulator(tree, wood, model=name, in_leaf=each, **model).frequencies(1)[0]
            for name in ('coupled', 'segments')
        ]
        for each in (True, False)
    )
    assert leafy[0] < 0.97 * bare[0]
    assert leafy[1] / leafy[0] == pytest.approx(bare[1] / bare[0], rel=0.005)


def test_every_segment_is_pushed_by_the_leaves_too():
    tree, wood = forked_tree(0.5, 0.6), species_named('spruce')
    ways = []
    for name in ('coupled', 'segments'):
        sim = make_simulator(tree, wood, model=name, gravity=0.0, damping_ratio=0.7)
        for _ in range(600):
            sim.step((2.0, 0.0, 0.0), DT)
        sim.place()
        ways.append(sim.tip_displacement[0])
    assert ways[1] == pytest.approx(ways[0], rel=0.05)


@pytest.mark.parametrize('model', FIDELITIES)
def test_a_tree_is_used_like_a_forest_of_one(stem, model):
    sim = make_simulator(stem, WOOD, model=model)
    sim.step((3.0, 1.0, 0.0), DT)
    assert sim.simulators == (sim,)
    assert sim.gusts is None
    assert sim.wind == pytest.approx([3.0, 1.0, 0.0])


@pytest.mark.parametrize('model', ['auto', 'segments'])
def test_a_reduced_simulator_keeps_to_one_reduced_model(stem, model):
    with pytest.raises(ParameterError, match=f"'{model}' is no model .* make_simulator knows"):
        SwaySimulator(stem, WOOD, model=model)


def test_the_model_is_that_of_the_settings(stem):
    assert make_simulator(stem, WOOD, Settings(model='branch')).model == 'branch'
    assert make_simulator(stem, WOOD, Settings(model='branch'), model='modes').model == 'modes'
    assert make_simulator(replace(stem, species='oak')).species is species_named('oak')
