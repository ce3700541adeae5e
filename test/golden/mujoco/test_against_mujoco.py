# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The articulated reference and the reduced model against tips by MuJoCo (`make_golden.py`)."""

from pathlib import Path

import numpy as np
import pytest
from tree_sway_lab.example_trees import forked_tree
from tree_sway_lab.segments.articulated import ArticulatedTree
from tree_sway_lab.tip_error import record_tips, tip_error

from tree_sway.core.drag.drag_law import AIR_DENSITY
from tree_sway.core.scene.make import make_simulator
from tree_sway.core.species.species import Species

FRAME, DAMPING = 1.0 / 60.0, 0.05
SPECIES = Species('forked', 'no twist', 8.0e9, 900.0, drag_coefficient=1.2, shear_ratio=500.0)


@pytest.fixture(scope='module')
def golden():
    return np.load(Path(__file__).with_name('forked_tips.npz'))


@pytest.fixture(scope='module')
def tree():
    return forked_tree(0.5, 0.6)


def error_of(model, tree, wind, truth, substeps=1):
    tips = record_tips(model, tree, wind, FRAME, substeps=substeps)[1::2]
    return tip_error(tree, tips, truth.astype(np.float64))


def test_golden_data_is_converged_and_agrees_with_the_beam(golden):
    assert golden['step_error'] < 1e-3
    assert golden['agreement'] == pytest.approx([1.0, 1.0], abs=0.01)


@pytest.mark.parametrize('share', [0.25, pytest.param(1.0, marks=pytest.mark.long)])
def test_articulated_tree_is_the_same_mechanism(golden, tree, share):
    frames = 2 * round(0.5 * share * len(golden['wind']))
    model = ArticulatedTree(
        tree,
        SPECIES.modulus,
        SPECIES.density,
        DAMPING,
        air_density=AIR_DENSITY,
        drag_coefficient=1.2,
    )
    wind, truth = golden['wind'][:frames], golden['same'][: frames // 2]
    assert error_of(model, tree, wind, truth, substeps=2) < 5e-3


@pytest.mark.parametrize('model', [12, 'full'])
def test_reduced_tree_errs_by_less_than_a_twentieth(golden, tree, model):
    model = make_simulator(tree, SPECIES, model=model, damping_ratio=DAMPING, gravity=0.0)
    assert error_of(model, tree, golden['wind'], golden['beam']) < 0.05


def test_uncoupled_branches_are_caught(golden, tree):
    model = make_simulator(tree, SPECIES, model='branch', damping_ratio=DAMPING, gravity=0.0)
    assert error_of(model, tree, golden['wind'], golden['beam']) > 0.5


def test_live_engine_repeats_the_golden_tips(golden, tree):
    pytest.importorskip('mujoco', reason='needs MuJoCo (pip install mujoco)')
    from tree_sway_lab.compare.mujoco_tree import MujocoTree
    from tree_sway_lab.compare.with_mujoco import mujoco_tips

    frames = 6
    model = MujocoTree(tree, SPECIES, DAMPING)
    tips = mujoco_tips(model, golden['wind'][:frames], 16)[1::2]
    # Half the golden data's steps.
    assert tip_error(tree, tips, golden['beam'][: frames // 2].astype(np.float64)) < 0.02
    assert model.agreement() == pytest.approx(golden['agreement'], rel=1e-6)
