# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Other methods behind the same simulator, and their refusal where they would explode."""

from __future__ import annotations

import numpy as np
import pytest

from tree_sway_ros.core.oscillators.rule_names import CONDITIONALLY_STABLE, REAL_TIME
from tree_sway_ros.core.oscillators.step_rules import stability_limit, STEP_RULES
from tree_sway_ros.core.simulator.simulator import SwaySimulator
from tree_sway_ros.core.tree.species import Species
from tree_sway_ros.errors import ParameterError
from tree_sway_ros.study.example_trees import forked_tree, tapered_stem

WOOD = Species('example', 'example', 8e9, 900.0, damping_bare=0.05)


@pytest.mark.parametrize('model', ['branch', 'modes'])
@pytest.mark.parametrize('integrator', REAL_TIME)
def test_every_method_sways_a_slow_stem_alike(model, integrator):
    tree = tapered_stem(6.0, np.linspace(0.05, 0.04, 7))
    tips = []
    for method in ('exact_foh', integrator):
        sim = SwaySimulator(tree, WOOD, model=model, integrator=method, gravity=0.0, enrich='none')
        for k in range(400):
            sim.step((3.0 + np.sin(0.02 * k), 0.0, 0.0), 1.0 / 240.0)
            sim.place()
            tips.append(sim.tip_displacement[0])
    exact, other = np.reshape(tips, (2, -1))
    assert np.linalg.norm(other - exact) <= 0.05 * np.linalg.norm(exact)


@pytest.mark.parametrize('integrator', ['semi_implicit_euler', 'rk4', 'verlet'])
def test_a_method_beyond_its_stable_region_is_refused_by_name(integrator):
    sim = SwaySimulator(forked_tree(0.4, 0.35), WOOD, model='coupled', integrator=integrator)
    with pytest.raises(ParameterError, match=rf'{integrator}.*its limit'):
        sim.step((1.0, 0.0, 0.0), 1.0 / 60.0)


def test_a_method_that_is_too_slow_for_a_frame_is_not_offered():
    assert 'radau_ggl' not in REAL_TIME
    with pytest.raises(ParameterError, match="unknown integrator 'radau_ggl'"):
        SwaySimulator(forked_tree(0.4, 0.35), WOOD, integrator='radau_ggl')


@pytest.mark.parametrize('integrator', ['semi_implicit_euler', 'rk4', 'verlet'])
def test_a_late_step_is_cut_where_the_method_would_explode(integrator):
    tree = tapered_stem(6.0, np.linspace(0.05, 0.04, 7))
    late, even = (
        SwaySimulator(tree, WOOD, model='branch', integrator=integrator, gravity=0.0)
        for _ in range(2)
    )
    wind = (4.0, 1.0, 0.0)
    for sim in (late, even):
        sim.step(wind, 1.0 / 120.0)
    late.step(wind, 1.0)
    for _ in range(120):
        even.step(wind, 1.0 / 120.0)
    assert late.tip_displacement == pytest.approx(even.tip_displacement, rel=1e-9)
    late.step(wind, 1.0 / 240.0)
    assert np.isfinite(late.place()).all()


def test_every_name_has_its_rule():
    assert set(STEP_RULES) == set(REAL_TIME)


@pytest.mark.parametrize('name', REAL_TIME)
def test_the_methods_that_are_cut_are_those_with_a_limit(name):
    assert (name in CONDITIONALLY_STABLE) == np.isfinite(stability_limit(name))
