# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Limp trees: nearer to the truth, no energy from nothing, stable."""

from dataclasses import replace
from functools import cache

from drawn_trees import crooked, SETTINGS, Sketch, UP, weeping, WOOD, young_whip
import numpy as np
import pytest
from simulators import FULL, turbulence

from tree_sway.core.checks import LONGEST_STEP
from tree_sway.core.drag.drag_law import DragLaw
from tree_sway.core.model.sway_model import SwayModel
from tree_sway.core.native.model import bytes_of, NativeModel
from tree_sway.core.native.stand import NativeStand
from tree_sway.core.run.simulator import SwaySimulator
from tree_sway.core.scene.make import make_simulator
from tree_sway.core.settings import Settings
from tree_sway.core.setup.preparation import prepare
from tree_sway.core.setup.reductions import FASTEST_LIMP, TreeReductions
from tree_sway.core.species.species import species_named
from tree_sway.core.tree.segment_frame import ends_of_poses
from tree_sway.core.tree.tree import tips_of_poses
from tree_sway.growth.builtin import builtin_tree

FRAME = 1.0 / 60.0

LONGEST_PART = 0.04
"""Longest part of a step in light wind [s]."""

FASTEST_TURN = 40.0
"""Largest rate of a key rotation [rad/s]."""

SLACK = 0.05
"""Share of its energy of motion and strain that a tree may gain of what it has lost."""


def record_tips(sim, wind):
    """Tips after each wind, (t, b, 3)."""
    tips = []
    for blowing in wind:
        sim.step(blowing, FRAME)
        tips.append(tips_of_poses(sim.tree, sim.place()))
    return np.array(tips)


@cache
def limp_model() -> SwayModel:
    return prepare(weeping(), WOOD, SETTINGS, model=40, cache=None)


def limp_tree(**changes):
    return SwaySimulator(limp_model(), **changes)


def test_only_trees_whose_twigs_hang_or_whip_are_limp():
    for tree, is_limp in ((weeping(), True), (young_whip(), True), (crooked(1, 12), False)):
        assert TreeReductions(tree, WOOD, SETTINGS).is_limp == is_limp
        arrays = prepare(tree, WOOD, SETTINGS, model=24).arrays()
        assert ({'segment_mass', 'weight_slopes'} <= arrays.keys()) == is_limp
    goldcrest = builtin_tree('goldcrest'), species_named('goldcrest')
    assert not TreeReductions(*goldcrest, Settings()).is_limp


@pytest.mark.parametrize('chosen', [40, *FULL])
def test_a_tree_without_inertia_takes_another_step_and_says_so(chosen):
    model = prepare(weeping(), WOOD, SETTINGS, model=chosen)
    weightless = replace(model, segment_mass=0.0 * model.segment_mass)
    sim = SwaySimulator(weightless)
    assert 'no inertia to solve with' in sim.banks[0].doubt
    assert np.isfinite(record_tips(sim, turbulence(9.0, 0.5))).all()


def test_a_number_of_coordinates_that_is_asked_for_is_not_cut():
    sim = make_simulator(weeping(3), WOOD, SETTINGS)
    assert sim.model == f'{len(sim.models[0].stiffness)}/60'
    assert make_simulator(weeping(3), WOOD, SETTINGS, model=3).model == '3'


def test_a_limp_tree_keeps_its_slow_coordinates():
    assert np.sqrt(limp_model().stiffness.max()) < FASTEST_LIMP
    to = Sketch()
    to.shoot(None, 0, UP, 0.1, 0.0002, 0.0001, 8)
    hair = prepare(to.tree(name='hair'), WOOD, SETTINGS)
    assert np.sqrt(hair.stiffness.min()) > FASTEST_LIMP


@pytest.mark.parametrize('tree', [young_whip(), weeping(3)])
def test_none_of_its_coordinates_is_lost_to_a_fast_one(tree):
    reductions = TreeReductions(tree, WOOD, SETTINGS)
    slow = int(np.sum(reductions.natural_modes(None).circular < FASTEST_LIMP))
    count = slow - 2
    assert len(reductions.modes(count).circular) == count
    assert len(reductions.modes(slow + 10).circular) == slow


def ends(sim, eta):
    """Find the ends of the segments at coordinates, (2, n, 3)."""
    model = sim.models[0]
    return np.array(ends_of_poses(sim.place_rotations(model.shapes @ eta), model.tree.length))


def middles(sim, eta):
    """Middles of the segments at coordinates, (n, 3)."""
    return ends(sim, eta).mean(axis=0)


def energy(sim):
    """Energy of motion, strain and weight [J], by the places of the segments."""
    model, (eta, rate, _) = sim.models[0], sim.banks[0].oscillators.swing
    mass, h = model.segment_mass[:, None], 1e-4
    base, tip = (ends(sim, eta + h * rate) - ends(sim, eta - h * rate)) / (2.0 * h)
    of_rods = np.sum(mass * (base**2 + base * tip + tip**2)) / 3.0
    weight = -mass * [0.0, 0.0, -model.settings.gravity]
    at_rest, gradient = middles(sim, 0.0 * eta), []
    for k, unit in enumerate(np.eye(len(eta))):
        step = 1e-4 / np.abs(model.shapes[:, k]).max()
        apart = middles(sim, step * unit) - middles(sim, -step * unit)
        gradient.append(np.sum(weight * apart) / (2.0 * step))
    # The stiffness has the second derivative of the weight's potential at rest.
    linear = np.array(gradient) @ eta - 0.5 * eta @ model.weight_slopes @ eta
    beyond = np.sum(weight * (middles(sim, eta) - at_rest)) - linear
    return 0.5 * of_rods + 0.5 * model.stiffness @ eta**2 + beyond


def test_without_wind_and_damping_the_energy_never_grows():
    """For a minute; the energy is that of the placed segments, not of columns of some age."""
    sim = SwaySimulator(replace(limp_model(), drag_law=DragLaw(0.0, 0.0, 0.0)))
    sim.tune(damping_ratio=0.0)
    rng = np.random.default_rng(3)
    for _ in range(60):
        sim.step((0.0, 0.0, 0.0), FRAME)
    _, rate, _ = sim.banks[0].oscillators.swing
    rate[:12] = rng.normal(size=12)
    rate *= 2.0 / np.abs(sim.models[0].shapes @ rate).max()
    energies = []
    for frame in range(3600):
        sim.step((0.0, 0.0, 0.0), FRAME)
        if frame % 20 == 0:
            energies.append(energy(sim))
    assert sim.counts.clamped == 0
    assert max(energies) <= (1.0 + 2.0 * SLACK) * energies[0]
    assert energies[3] > 0.3 * energies[0]  # and does not stop


@pytest.mark.parametrize('case', ['storm', 'gusts', 'uneven steps', 'long steps', 'tuned', 'push'])
def test_nothing_makes_it_run_away(case):
    sim, rng = limp_tree(), np.random.default_rng(6)
    wind = turbulence(15.0, 8.0, 5)
    steps = np.full(len(wind), FRAME)
    if case == 'storm':
        wind = 5.0 * wind
    elif case == 'gusts':
        wind = rng.normal(0.0, 20.0, wind.shape)
    elif case == 'uneven steps':
        steps = rng.uniform(1e-3, 2.0 * LONGEST_PART, len(wind))
    elif case == 'long steps':
        steps[:] = LONGEST_PART
    for frame, (blowing, dt) in enumerate(zip(wind, steps, strict=True)):
        if case == 'tuned' and frame % 60 == 0:
            sim.tune(stiffness_factor=rng.uniform(0.8, 3.0), gravity=rng.uniform(5.0, 12.0))
        if case == 'push' and frame % 30 == 0:
            sim.push(int(rng.integers(sim.tree.n_segments)), rng.normal(0.0, 5.0, 3), 0.3)
        sim.step(np.clip(blowing, -80.0, 80.0), dt)
        assert np.isfinite(sim.place()).all()
    assert sim.counts.restarted == 0
    assert sim.counts.reduced == 0


def test_a_long_step_is_taken_in_parts():
    at_once, apart = limp_tree(), limp_tree()
    for _ in range(5):
        at_once.step((6.0, 2.0, 0.0), 4.0 * LONGEST_PART)
        for _ in range(4):
            apart.step((6.0, 2.0, 0.0), LONGEST_PART)
    np.testing.assert_allclose(at_once.place(), apart.place(), atol=1e-9)
    at_once.step((6.0, 2.0, 0.0), LONGEST_STEP)
    assert np.isfinite(at_once.place()).all()


def test_a_branch_that_would_turn_too_fast_is_bounded_and_counted():
    sim = limp_tree()
    for blowing in turbulence(25.0, 1.0, 5):
        sim.step(blowing, FRAME)
    assert sim.counts.clamped == 0
    by_key = sim.models[0].shapes
    _, rates, _ = sim.banks[0].oscillators.swing
    rates *= 3.0 * FASTEST_TURN / np.abs(by_key @ rates).max()
    sim.step((25.0, 0.0, 0.0), FRAME)
    assert sim.counts.clamped == 1
    assert np.abs(by_key @ rates).max() <= (1.0 + 1e-9) * FASTEST_TURN


def test_trees_of_a_stand_move_as_each_does_alone():
    """Bit for bit, though they are of several sizes and one has run away."""
    trees = weeping(), young_whip(), weeping(3)
    prepared = [prepare(each, WOOD, SETTINGS) for each in trees]
    models = [NativeModel(bytes_of(each.native_arrays())) for each in prepared]
    kinds = np.array([1, 0, 2, 1])
    places, speeds = np.array([[0.0, 0.0, 0.0, 0.5, 1.1]] * 4), np.ones(4)
    together = NativeStand(models, kinds, places, speeds)
    alone = [NativeStand(models, kinds[k : k + 1], places[:1], speeds[:1]) for k in range(4)]
    for stand in (together, *alone):
        stand.set_step(FRAME)
    for frame, wind in enumerate(turbulence(9.0, 1.0, 2)):
        if frame == 20:
            together.states.rate[0] = alone[0].states.rate[0] = np.nan
        together.step(np.tile(wind, (4, 1)))
        for k, stand in enumerate(alone):
            stand.step(wind[None])
            np.testing.assert_array_equal(together.states.eta[k], stand.states.eta[0])
    assert (np.abs(together.states.eta).max(axis=1) > 0.0).all()


def test_it_stands_still_in_still_air():
    sim = limp_tree()
    rest = sim.place()
    for _ in range(120):
        sim.step((0.0, 0.0, 0.0), FRAME)
    np.testing.assert_allclose(sim.place(), rest, atol=1e-5)


def test_it_begins_anew_after_a_reset():
    sim, wind = limp_tree(), turbulence(9.0, 1.0, 2)
    first = record_tips(sim, wind)
    sim.reset()
    np.testing.assert_array_equal(record_tips(sim, wind), first)


def test_it_goes_on_from_a_state_nearly_as_it_would_have():
    sim, other, wind = limp_tree(), limp_tree(), turbulence(9.0, 4.0, 2)
    for blowing in wind[:180]:
        sim.step(blowing, FRAME)
    other.set_state(sim.state())
    tips = [record_tips(each, wind[180:]) for each in (sim, other)]
    rest = weeping().end[weeping().branch_first[1:] - 1]
    assert np.abs(tips[0] - tips[1]).max() < 0.02 * np.abs(tips[0] - rest).max()


def test_slopes_of_the_weight_are_the_second_derivative_of_its_potential():
    sim = limp_tree()
    model = sim.models[0]
    weight, rest = model.segment_mass * model.settings.gravity, middles(sim, 0.0 * model.stiffness)
    steps = 2e-3 / np.abs(model.shapes).max(axis=0)
    rng = np.random.default_rng(1)
    for i, j in rng.integers(len(steps), size=(20, 2)):
        a, b = np.eye(len(steps))[i] * steps[i], np.eye(len(steps))[j] * steps[j]
        four = [
            (middles(sim, s * a + t * b) - rest)[:, 2] @ -weight * s * t
            for s in (-1.0, 1.0) for t in (-1.0, 1.0)
        ]  # fmt: skip
        slope = sum(four) / (4.0 * steps[i] * steps[j])
        assert slope == pytest.approx(model.weight_slopes[i, j], rel=1e-3, abs=1e-3)
