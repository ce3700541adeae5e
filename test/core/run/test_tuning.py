# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Damping, stiffness and gravity changed while a tree sways: effect, no jump, refusals."""

from __future__ import annotations

from drawn_trees import crown, WOOD
import numpy as np
import pytest
from simulators import AUTO, FULL

from tree_sway.core.run.tuning import GLIDE
from tree_sway.core.scene.make import make_simulator
from tree_sway.core.scene.placed_tree import PlacedTree
from tree_sway.core.scene.scene import Scene
from tree_sway.errors import ParameterError

DT = 1.0 / 60.0
CALM, BREEZE = (0.0, 0.0, 0.0), (5.0, 1.0, 0.0)


@pytest.fixture(scope='module')
def tree():
    return crown()


EVERY = 3
"""Steps from one place of the tip that is looked at to the next."""


def free_sway(sim, seconds=12.0):
    """Tip along x after a blow, from the glide's end on, once every `EVERY` steps, (t,)."""
    for _ in range(round(2.0 * GLIDE / DT)):
        sim.step(CALM, DT)
    for _ in range(15):
        sim.step((12.0, 0.0, 0.0), DT)
    tips = []
    for _ in range(round(seconds / (EVERY * DT))):
        for _ in range(EVERY):
            sim.step(CALM, DT)
        tips.append(float(sim.tip_displacement[0]))
    return np.array(tips)


def frequency(tips):
    power = np.abs(np.fft.rfft(tips * np.hanning(len(tips)), 16 * len(tips)))
    return float(np.argmax(power)) / (16 * len(tips) * EVERY * DT)


@pytest.mark.parametrize('model', ['branch', 12, *FULL])
def test_a_stiffer_tree_sways_as_one_made_so(tree, model):
    stiff = WOOD.__class__(
        'stiff', 'stiff', 2.0 * WOOD.modulus, WOOD.density,
        damping_bare=WOOD.damping_bare, shear_ratio=WOOD.shear_ratio,
    )  # fmt: skip
    made = make_simulator(tree, stiff, model=model)
    tuned = make_simulator(tree, WOOD, model=model)
    before = frequency(free_sway(make_simulator(tree, WOOD, model=model), 4.0))
    tuned.tune(stiffness_factor=2.0)
    wanted = frequency(free_sway(made))
    assert frequency(free_sway(tuned)) == pytest.approx(wanted, rel=0.01)
    assert abs(wanted / before - 1.0) > 0.3


def sway_after_tuning(sim, steps):
    sim.tune(stiffness_factor=3.0, damping_ratio=0.3)
    for dt in steps:
        sim.step(BREEZE, dt)
    return sim.tip_displacement


@pytest.mark.parametrize('is_scene', [False, True])
def test_steps_of_varying_length_take_a_change_as_equal_ones_do(tree, is_scene):
    def made():
        if is_scene:
            one = PlacedTree('t', tree, species=WOOD)
            return Scene([one], convection_ratio=np.inf).simulator(model=12)
        return make_simulator(tree, WOOD, model=12)

    equal = sway_after_tuning(made(), np.full(120, DT))
    varying = sway_after_tuning(made(), DT * np.tile([1.001, 0.999], 60))
    untuned = made()
    for _ in range(120):
        untuned.step(BREEZE, DT)
    assert np.linalg.norm(varying - equal) < 0.01 * np.linalg.norm(equal)
    assert np.linalg.norm(untuned.tip_displacement - equal) > 0.3 * np.linalg.norm(equal)


@pytest.mark.parametrize('bad', [0.0, -0.01, np.nan, np.inf])
def test_a_refused_step_does_not_advance_a_change(tree, bad):
    sim = make_simulator(tree, WOOD, model=12)
    sim.tune(stiffness_factor=2.0)
    before = sim.banks[0].oscillators.tunable.stiffness.copy()
    with pytest.raises(ParameterError, match='time step'):
        sim.step(BREEZE, bad)
    assert (sim.banks[0].oscillators.tunable.stiffness == before).all()


@pytest.mark.parametrize('model', ['branch', 12])
def test_more_damping_ends_the_sway_as_in_a_tree_made_so(tree, model):
    tuned = make_simulator(tree, WOOD, model=model)
    tuned.tune(damping_ratio=0.3)
    made = free_sway(make_simulator(tree, WOOD, model=model, damping_ratio=0.3), 3.0)
    found = free_sway(tuned, 3.0)
    light = free_sway(make_simulator(tree, WOOD, model=model), 3.0)
    assert np.abs(found - made).max() < 0.02 * np.abs(made).max()
    assert np.abs(light - made).max() > 0.2 * np.abs(made).max()


@pytest.mark.parametrize('model', [12])
def test_weight_changes_as_in_a_tree_made_with_it(tree, model):
    tuned = make_simulator(tree, WOOD, model=model, gravity=9.81)
    tuned.tune(gravity=2.0)
    wanted = frequency(free_sway(make_simulator(tree, WOOD, model=model, gravity=2.0)))
    assert frequency(free_sway(tuned)) == pytest.approx(wanted, rel=0.01)


def test_the_volume_rule_is_not_tuned(tree):
    sim = make_simulator(tree, WOOD, model='branch', volume_stiffness=2e5)
    with pytest.raises(ParameterError, match='volume rule'):
        sim.tune(damping_ratio=0.2)


@pytest.mark.parametrize('model', ['branch', 12])
def test_no_pose_jumps(tree, model):
    sim = make_simulator(tree, WOOD, model=model)
    for _ in range(300):
        sim.step(BREEZE, DT)
    before = [sim.place()]
    for _ in range(60):
        sim.step(BREEZE, DT)
        before.append(sim.place())
    usual = np.abs(np.diff(before, axis=0)[..., :3]).max()
    sim.tune(stiffness_factor=0.7, damping_ratio=0.02, gravity=12.0)
    after = [sim.place()]
    for _ in range(60):
        sim.step(BREEZE, DT)
        after.append(sim.place())
    second = np.abs(np.diff(after, 2, axis=0)[..., :3]).max()
    assert np.array_equal(after[0], before[-1])
    assert second < max(usual, 1e-3)


@pytest.mark.parametrize(
    ('changes', 'why'),
    [
        ({'damping_ratio': -0.1}, 'damping_ratio'),
        ({'damping_ratio': float('nan')}, 'damping_ratio'),
        ({'stiffness_factor': 0.0}, 'stiffness_factor'),
        ({'gravity': 31.0}, 'gravity'),
        ({'volume_stiffness': 1.0e5}, 'cannot change while the tree sways'),
        ({'modulus': 1e9}, 'cannot change while the tree sways'),
        ({'stiffness_factor': 0.1, 'gravity': 30.0}, 'buckles'),
    ],
)
def test_what_cannot_be_is_refused_and_nothing_changes(tree, changes, why):
    sim, other = (make_simulator(tree, WOOD) for _ in range(2))
    with pytest.raises(ParameterError, match=why):
        sim.tune(**changes)
    for _ in range(45):
        sim.step(BREEZE, DT)
        other.step(BREEZE, DT)
    assert np.array_equal(sim.place(), other.place())


def test_weight_needs_a_tree_that_was_made_with_it(tree):
    with pytest.raises(ParameterError, match='without weight'):
        make_simulator(tree, WOOD, gravity=0.0).tune(gravity=9.81)


@pytest.mark.parametrize(
    ('model', 'factor'),
    [(12, 0.6), ('branch', 0.6), *(pytest.param('auto', 2.0, marks=each.marks) for each in AUTO)],
)
def test_a_steady_wind_bends_a_tuned_tree_as_one_made_so(tree, model, factor):
    wood = WOOD.__class__(
        'x', 'x', factor * WOOD.modulus, WOOD.density,
        damping_bare=WOOD.damping_bare, shear_ratio=WOOD.shear_ratio,
    )  # fmt: skip
    # Damped, so that it soon comes to rest.
    tuned, made = (
        make_simulator(tree, each, model=model, gravity=0.0, damping_ratio=0.3)
        for each in (WOOD, wood)
    )
    tuned.tune(stiffness_factor=factor)
    for _ in range(300):
        tuned.step(BREEZE, DT), made.step(BREEZE, DT)
    assert tuned.tip_displacement == pytest.approx(
        made.tip_displacement, abs=0.02 * np.linalg.norm(made.tip_displacement)
    )


def test_a_forest_takes_a_change_as_a_whole(tree):
    scene = Scene([PlacedTree(f't{k}', tree, species=WOOD, x=9.0 * k) for k in range(2)])
    forest = scene.simulator(model='branch')
    forest.tune(damping_ratio=0.2)
    assert [each.check_tuning().damping_ratio for each in forest.simulators] == [0.2, 0.2]
    with pytest.raises(ParameterError):
        forest.tune(damping_ratio=2.0)


def test_trees_that_share_a_table_take_a_change_as_one_that_does_not(tree):
    trees = [PlacedTree(f't{k}', tree, species=WOOD) for k in range(2)]
    pair = Scene(trees, convection_ratio=np.inf).simulator(model=20)
    alone = make_simulator(tree, WOOD, model=20)
    for sim in (pair, alone):
        for frame in range(60):
            if frame == 30:
                sim.tune(damping_ratio=0.3)
            sim.step(BREEZE, DT)
    assert pair.tip_displacement == pytest.approx(alone.tip_displacement, abs=1e-12)
