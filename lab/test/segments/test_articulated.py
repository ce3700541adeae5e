# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The articulated tree against the beam frame, energy, order of the method, and storms."""

from functools import cache
from itertools import pairwise

import numpy as np
import pytest
from tree_sway_lab.example_trees import (
    EXAMPLE_DENSITY,
    EXAMPLE_MODULUS,
    forked_tree,
    RATIOS,
    tapered_stem,
)
from tree_sway_lab.frame.frame import frame_model
from tree_sway_lab.frame_means import frame_means
from tree_sway_lab.segments.articulated import ArticulatedTree
from tree_sway_lab.segments.articulated_kernel import articulation_of, motion_of
from tree_sway_lab.segments.articulated_modes import joint_mass, joint_modes, joint_stiffness
from tree_sway_lab.segments.articulated_step import respond, scratch_of
from tree_sway_lab.segments.refinement import refined
from tree_sway_lab.tip_error import record_tips, tip_error

from tree_sway.core.tree.building import tree_from_segments
from tree_sway.core.tree.tree import tips_of_poses
from tree_sway.errors import TreeError

E, RHO = EXAMPLE_MODULUS, EXAMPLE_DENSITY
UNDAMPED = (0.0, 0.0)
DT = 1.0 / 60.0


@cache
def bush():
    """Make a stem with three branches, short to compute."""
    start = [[0, 0, 0], [0, 0, 1], [0, 0, 1], [0, 0, 2], [0.5, 0, 1.5], [0, 0, 2]]
    end = [[0, 0, 1], [0, 0, 2], [0.5, 0, 1.5], [0, 0.3, 2.9], [1.0, 0.2, 1.7], [-0.6, 0.1, 2.4]]
    width = [
        [0.05, 0.04],
        [0.04, 0.03],
        [0.02, 0.015],
        [0.03, 0.01],
        [0.015, 0.01],
        [0.015, 0.008],
    ]
    return tree_from_segments(start, end, width, parent=[-1, 0, 0, 1, 2, 1])


def wind_of(t):
    return 12.0 * np.sin(3.0 * t) ** 2 * np.array([np.cos(t), np.sin(t), 0.2])


def tips_of(model):
    return model.node_positions[model.tree.branch_first[1:] - 1]


def sway(model, dt, duration=1.0):
    model.reset()
    for step in range(round(duration / dt)):
        model.step(wind_of((step + 0.5) * dt), dt)
    return tips_of(model)


@pytest.mark.parametrize('gravity', [0.0, 9.81])
@pytest.mark.parametrize('ratios', RATIOS[::2])
def test_frequencies_converge_to_the_beams_with_the_square_of_the_segments(ratios, gravity):
    tree = forked_tree(*ratios)
    beam = frame_model(tree, E, RHO, gravity, shear_ratio=500.0, subdivisions=4).frequencies(6)
    error = []
    for pieces in (1, 2):
        model = ArticulatedTree(
            tree, E, RHO, gravity=gravity, subdivisions=pieces, rayleigh=UNDAMPED
        )
        error.append(model.linear_modes(6)[0] / beam - 1.0)
    assert np.abs(error[0]).max() < 0.011
    assert error[1] == pytest.approx(error[0] / 4.0, rel=0.1)


def test_twist_is_the_beams_too():
    tree = forked_tree(*RATIOS[0])
    beam = frame_model(tree, E, RHO, subdivisions=4).frequencies(6)
    model = ArticulatedTree(tree, E, RHO, subdivisions=2, twist_ratio=2 / 2.6, rayleigh=UNDAMPED)
    assert model.linear_modes(6)[0] == pytest.approx(beam, rel=2e-3)


def test_uniform_cantilever_of_twenty_segments():
    stem = tapered_stem(5.0, np.full(21, 0.1))
    found = ArticulatedTree(stem, E, RHO, rayleigh=UNDAMPED).linear_modes(6)[0][::2]
    root = 2.0 * np.pi * found * 25.0 * np.sqrt(16.0 * RHO / E) / 0.1
    for value, expected, band in zip(root, (3.516, 22.03, 61.70), (0.01, 0.03, 0.05), strict=True):
        assert value == pytest.approx(expected, rel=band)


def test_stem_above_greenhill_length_is_refused():
    length = 1.02 * (7.8373 * E * 0.1**2 / (16.0 * RHO * 9.81)) ** (1 / 3)
    with pytest.raises(TreeError, match='buckles'):
        ArticulatedTree(tapered_stem(length, np.full(21, 0.1)), E, RHO, gravity=9.81)


def test_free_decay_has_the_frequency_and_damping_of_the_linear_mode():
    model = ArticulatedTree(bush(), E, RHO, 0.04, 0.0, subdivisions=2)
    frequency, turn, _ = joint_modes(model.bodies, 0.0, 1)
    model.state.rate[:] = 1e-3 * turn[0]
    dt = 1.0 / (120.0 * frequency[0])
    rest = bush().end[bush().branch_first[1:] - 1]
    sway_of_tip = []
    for _ in range(1200):
        model.step(np.zeros(3), dt)
        sway_of_tip.append(tips_of(model)[0, 0] - rest[0, 0])
    sway_of_tip = np.array(sway_of_tip)
    crossing = np.flatnonzero(np.diff(np.sign(sway_of_tip)))
    part = sway_of_tip[crossing] / (sway_of_tip[crossing] - sway_of_tip[crossing + 1])
    period = 2.0 * np.mean(np.diff(crossing + part)) * dt
    assert 1.0 / period == pytest.approx(frequency[0] * np.sqrt(1 - 0.04**2), rel=1e-3)
    peaks = [np.abs(sway_of_tip[a:b]).max() for a, b in pairwise(crossing)]
    decrement = -np.polyfit(np.arange(len(peaks)), np.log(peaks), 1)[0] / np.pi
    assert decrement / np.sqrt(1 + decrement**2) == pytest.approx(0.04, rel=0.01)


def test_step_is_of_second_order():
    model = ArticulatedTree(bush(), E / 30, RHO, 0.05, twist_ratio=0.8)
    fine = sway(model, 1 / 3840)
    assert np.abs(fine - bush().end[bush().branch_first[1:] - 1]).max() > 0.1
    error = [np.abs(sway(model, dt) - fine).max() for dt in (1 / 240, 1 / 480, 1 / 960)]
    assert np.diff(np.log2(error)) == pytest.approx([-2.0, -2.0], abs=0.25)


def test_undamped_tree_keeps_its_energy_and_falls_as_gravity_says():
    model = ArticulatedTree(
        bush(), E / 30, RHO, gravity=9.81, twist_ratio=0.8, drag_coefficient=0.0, rayleigh=UNDAMPED
    )
    for _ in range(60):
        model.step(np.zeros(3), DT)
    assert np.abs(model.state.rate).max() < 1e-12, 'rest is the loaded shape'
    bodies = model.bodies
    rng = np.random.default_rng(0)
    model.state.rate[:] = 0.5 * rng.standard_normal(model.state.rate.shape)
    start = energy(model, bodies)
    for _ in range(4000):
        model.step(np.zeros(3), 1e-4)
    assert energy(model, bodies) == pytest.approx(start, rel=1e-3)


def energy(model, bodies):
    """Kinetic, elastic and potential energy in [J] by the plain sums over bodies."""
    rotation = np.zeros((len(bodies.mass), 3, 3))
    spin, speed, place = np.zeros((3, len(bodies.mass), 3))
    total = 0.0
    for i, carrier in enumerate(bodies.carrier):
        w, v = model.state.turn[i, 0], model.state.turn[i, 1:]
        cross = np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])
        own = np.eye(3) + 2 * w * cross + 2 * cross @ cross
        has_carrier = carrier >= 0
        base = rotation[carrier] if has_carrier else np.eye(3)
        arm = base @ bodies.arm[i]
        rotation[i] = base @ own
        spin[i] = (spin[carrier] if has_carrier else 0) + rotation[i] @ model.state.rate[i]
        speed[i] = speed[carrier] + np.cross(spin[carrier], arm) if has_carrier else 0.0
        place[i] = (place[carrier] if has_carrier else 0) + arm
        r = rotation[i] @ bodies.centre[i]
        velocity = speed[i] + np.cross(spin[i], r)
        inertia = rotation[i] @ bodies.inertia[i] @ rotation[i].T
        total += 0.5 * bodies.mass[i] * velocity @ velocity + 0.5 * spin[i] @ inertia @ spin[i]
        total += 9.81 * bodies.mass[i] * (place[i] + r)[2]
        angle = 2.0 * np.arctan2(np.linalg.norm(v), w)
        turn = v * angle / np.linalg.norm(v) if np.linalg.norm(v) > 0 else v
        twist = 2.0 * np.arctan2(v @ bodies.axis[i], w)
        total += 0.5 * bodies.bend[i] * turn @ turn - bodies.rest_torque[i] @ turn
        total += 0.5 * (bodies.twist[i] - bodies.bend[i]) * twist**2
    return total


def test_long_steps_in_storms_stay_finite():
    model = ArticulatedTree(forked_tree(*RATIOS[0]), E, RHO, 0.02)
    rng = np.random.default_rng(3)
    for speed in (10.0, 30.0, 60.0):
        model.reset()
        for _ in range(120):
            model.step(speed * rng.choice([-1.0, 1.0], 3), DT)
        assert np.isfinite(model.state.turn).all()
        assert np.linalg.norm(tips_of(model), axis=1).max() < 15.0


def test_damped_modes_do_not_shake_a_straight_stem_that_bends_far():
    stem = tapered_stem(6.0, np.full(25, 0.06))
    model = ArticulatedTree(stem, E, RHO, 0.05, gravity=9.81, twist_ratio=1.0 / 7.0)
    for _ in range(900):
        model.step([28.0, 0.0, 0.0], DT)
    assert np.abs(model.state.rate).max() < 1e-3
    assert model.node_positions[-1, 0] == pytest.approx(1.18, rel=0.02)


def test_weight_and_steady_drag_give_the_frames_static_sway():
    stem = tapered_stem(4.0, np.linspace(0.06, 0.03, 9))
    model = ArticulatedTree(stem, E, RHO, 0.5, 1.1, air_density=1.2, subdivisions=2)
    for _ in range(600):
        model.step([3.0, 0.0, 0.0], DT)
    width = 0.5 * (stem.base_diameter + stem.tip_diameter)
    force = np.zeros((8, 3))
    force[:, 0] = 0.5 * 1.2 * 1.1 * width * stem.length * 9.0
    frame = frame_model(stem, E, RHO)
    beam = frame.static(force)[frame.end_node]
    assert model.node_positions[-1, 0] == pytest.approx(beam[-1, 0], rel=5e-3)


def test_poses_join_and_point_along_the_chords():
    tree = bush()
    model = ArticulatedTree(tree, E / 30, RHO, subdivisions=3)
    assert model.place()[:, :3] == pytest.approx(tree.start)
    assert tips_of_poses(tree, model.place()) == pytest.approx(tree.end[tree.branch_first[1:] - 1])
    sway(model, DT)
    poses = model.place()
    assert np.linalg.norm(poses[:, 3:], axis=1) == pytest.approx(1.0)
    parent = tree.segment_parent[1:]
    assert poses[1:, :3] == pytest.approx(model.node_positions[parent])
    shrunk = np.linalg.norm(tips_of_poses(tree, poses) - tips_of(model), axis=1)
    assert shrunk.max() < 2e-3, "a bent segment's chord is hardly shorter than the segment"


def test_mass_matrix_is_that_of_the_algorithm():
    model = ArticulatedTree(
        bush(), E, RHO, drag_coefficient=0.0, rayleigh=UNDAMPED, twist_ratio=0.8
    )
    n = bush().n_segments
    mass = joint_mass(model.bodies).toarray()
    scratch = scratch_of(n)
    out, torque = np.zeros((n, 3)), np.linspace(-1.0, 1.0, 3 * n).reshape(n, 3)
    model.bodies.rest_torque[:] = torque
    respond(
        model.bodies, model.laws, model.state.turn, model.state.rate, np.zeros((n, 3)), 0.0,
        motion_of(n), articulation_of(n), scratch, out,
    )  # fmt: skip
    assert mass @ out.ravel() == pytest.approx(torque.ravel(), abs=1e-9)
    assert mass == pytest.approx(mass.T)
    stiffness = joint_stiffness(model.bodies, 9.81).toarray()
    assert stiffness == pytest.approx(stiffness.T)


def test_refined_tree_is_the_same_wood_with_children_in_place():
    tree = forked_tree(*RATIOS[1])
    cut = refined(tree, 3)
    assert cut.volume.sum() == pytest.approx(tree.volume.sum())
    assert cut.end[2::3] == pytest.approx(tree.end)
    assert cut.place_on_parent == pytest.approx(1.0)
    first = cut.branch_first[1:-1]
    assert cut.start[first] == pytest.approx(cut.end[cut.segment_parent[first]])


def test_measure_scores_a_still_tree_one_and_the_truth_nought():
    tree = bush()
    model = ArticulatedTree(tree, E / 30, RHO)
    wind = np.array([wind_of(t) for t in np.arange(30) * DT])
    truth = record_tips(model, tree, wind, DT)
    rest = np.broadcast_to(tree.end[tree.branch_first[1:] - 1], truth.shape)
    assert tip_error(tree, rest, truth) == pytest.approx(1.0)
    assert tip_error(tree, truth, truth) == 0.0


def test_frame_means_are_exact_for_straight_lines_between_samples():
    time = np.array([5.0, 5.05, 5.1, 5.25])
    velocity = np.array([[0.0, 1, 0], [1.0, 1, 0], [0.0, 1, 0], [3.0, 1, 0]])
    means = frame_means(time, velocity, 0.1)
    assert means == pytest.approx(np.array([[0.5, 1, 0], [1.0, 1, 0]]))
    fine = frame_means(time, velocity, 0.05)
    assert fine[:, 0] == pytest.approx([0.5, 0.5, 0.5, 1.5, 2.5])
    assert frame_means(time, velocity, 1 / 60).mean(axis=0) == pytest.approx([1.1, 1, 0])


def test_forked_trees_have_three_children_a_branch():
    for generations, branches in ((1, 1), (3, 13), (4, 40)):
        tree = forked_tree(*RATIOS[0], generations=generations)
        assert tree.n_branches == branches
        assert tree.n_segments == 6 * branches
