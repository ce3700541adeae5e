# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The articulated-body algorithm and its modes against plain sums over bodies."""

from functools import cache

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from tree_sway_lab.example_trees import tapered_stem
from tree_sway_lab.segments.articulated import ArticulatedTree
from tree_sway_lab.segments.articulated_kernel import (
    articulation_of,
    load,
    motion_of,
    move,
    push,
)
from tree_sway_lab.segments.articulated_modes import (
    end_displacements,
    joint_mass,
    joint_modes,
    joint_stiffness,
)
from tree_sway_lab.segments.articulated_step import respond, scratch_of
from tree_sway_lab.segments.rotation_kernel import turn_on

from tree_sway.core.tree.building import tree_from_segments

E, RHO, G = 3.0e8, 900.0, 9.81


@cache
def tree():
    """Make a stem with three branches, none in one plane."""
    start = [[0, 0, 0], [0, 0, 1], [0, 0, 1], [0, 0, 2], [0.5, 0, 1.5]]
    end = [[0, 0, 1], [0, 0, 2], [0.5, 0, 1.5], [0, 0.3, 2.9], [1.0, 0.2, 1.7]]
    width = [[0.05, 0.04], [0.04, 0.03], [0.02, 0.015], [0.03, 0.01], [0.015, 0.01]]
    return tree_from_segments(start, end, width, parent=[-1, 0, 0, 1, 2])


def model(**changes):
    chosen = {
        'gravity': G,
        'drag_coefficient': 0.0,
        'rayleigh': (0.0, 0.0),
        'twist_ratio': 0.8,
    } | changes
    return ArticulatedTree(tree(), E, RHO, **chosen)


def accelerations(m, turn, rate):
    n, out = len(turn), np.empty_like(rate)
    respond(
        m.bodies,
        m.laws,
        turn,
        rate,
        np.zeros((n, 3)),
        0.0,
        motion_of(n),
        articulation_of(n),
        scratch_of(n),
        out,
    )
    return out


def moved(turn, by):
    out = np.empty_like(turn)
    for i in range(len(turn)):
        turn_on(turn[i], tuple(by[i]), out[i])
    return out


def swaying(m, seed=0):
    rng = np.random.default_rng(seed)
    turn = moved(m.state.turn, 0.3 * rng.normal(size=m.state.rate.shape))
    return turn, rng.normal(size=m.state.rate.shape)


def plain_bodies(bodies, turn, rate):
    """Rotations, places and velocities of the centres, spins: sums from the root out."""
    n = len(turn)
    rotation, spin, joint, speed = np.zeros((n, 3, 3)), *np.zeros((3, n, 3))
    for i, p in enumerate(bodies.carrier):
        below = rotation[p] if p >= 0 else np.eye(3)
        rotation[i] = below @ Rotation.from_quat(np.roll(turn[i], -1)).as_matrix()
        arm = below @ bodies.arm[i]
        joint[i], spin[i] = arm, rotation[i] @ rate[i]
        if p >= 0:
            joint[i] += joint[p]
            spin[i] += spin[p]
            speed[i] = speed[p] + np.cross(spin[p], arm)
    lever = np.einsum('nij,nj->ni', rotation, bodies.centre)
    return rotation, joint + lever, speed + np.cross(spin, lever), spin


def test_motion_is_that_of_the_plain_sums():
    m = model()
    turn, rate = swaying(m)
    matrices = Rotation.from_quat(np.roll(turn, -1, axis=1)).as_matrix()
    motion = motion_of(len(turn))
    move(m.bodies, matrices, rate, motion)
    rotation, _, velocity, spin = plain_bodies(m.bodies, turn, rate)
    assert motion.rotation == pytest.approx(rotation, abs=1e-13)
    assert motion.spin == pytest.approx(spin, abs=1e-13)
    lever = np.einsum('nij,nj->ni', rotation, m.bodies.centre)
    assert motion.velocity + np.cross(spin, lever) == pytest.approx(velocity, abs=1e-13)


@pytest.mark.parametrize('seed', range(3))
def test_angular_momentum_about_the_root_changes_by_weight_and_the_root_joint(seed):
    """Far from rest and turning fast, so that every bias term counts."""
    m = model()
    bodies = m.bodies
    turn, rate = swaying(m, seed)
    accel = accelerations(m, turn, rate)
    root = bodies.arm[0]

    def momentum(t):
        # Rates are in axes that turn with the body: to second order both advance together.
        turn_t = moved(turn, t * rate + 0.5 * t * t * accel)
        rotation, centre, velocity, spin = plain_bodies(bodies, turn_t, rate + t * accel)
        inertia = np.einsum('nij,njk,nlk->nil', rotation, bodies.inertia, rotation)
        own = np.einsum('nij,nj->ni', inertia, spin)
        return (bodies.mass[:, None] * np.cross(centre - root, velocity) + own).sum(axis=0)

    h = 1e-5
    rise = (8 * (momentum(h) - momentum(-h)) - momentum(2 * h) + momentum(-2 * h)) / (12 * h)
    rotation, centre, _, _ = plain_bodies(bodies, turn, rate)
    weight = np.cross(centre - root, -G * bodies.mass[:, None] * [0.0, 0.0, 1.0]).sum(axis=0)
    outside = rise - weight

    def energy(by):
        """Of the root's spring, less the work of the torque it bears at rest."""
        q = np.empty(4)
        turn_on(turn[0], tuple(by), q)
        v, axis = Rotation.from_quat(np.roll(q, -1)).as_rotvec(), bodies.axis[0]
        twist = 2.0 * np.arctan2(q[1:] @ axis, q[0])
        spring = bodies.bend[0] * v @ v + (bodies.twist[0] - bodies.bend[0]) * twist**2
        return 0.5 * spring - bodies.rest_torque[0] @ v

    slope = [(energy(1e-5 * e) - energy(-1e-5 * e)) / 2e-5 for e in np.eye(3)]
    assert outside == pytest.approx(-rotation[0] @ slope, rel=1e-5, abs=1e-5 * np.abs(slope).max())


def test_a_push_is_felt_by_every_joint_below_it():
    m = model(gravity=0.0)
    n, force, body = tree().n_segments, (3.0, -2.0, 1.0), 3
    place = tuple(m.bodies.reach[body, 1] * m.bodies.axis[body])
    motion, scratch = motion_of(n), articulation_of(n)
    move(m.bodies, np.tile(np.eye(3), (n, 1, 1)), np.zeros((n, 3)), motion)
    load(m.bodies, motion, 0.0, 0.0, scratch)
    push(body, place, force, 0.5, scratch)
    unit = np.eye(3 * n).reshape(3 * n, n, 3)
    generalised = 0.5 * end_displacements(m.bodies, unit)[:, body] @ np.array(force)
    # Force and moment, passed on from joint to joint.
    total = np.zeros((n, 3))
    for i in range(n - 1, -1, -1):
        total[i] -= scratch.moment[i]
        p = m.bodies.carrier[i]
        if p >= 0:
            total[p] += total[i]
            scratch.force[p] += scratch.force[i]
            total[p] -= np.cross(m.bodies.arm[i], scratch.force[i])
    assert total.ravel() == pytest.approx(generalised, abs=1e-12)


@pytest.mark.parametrize('gravity', [0.0, G])
def test_small_turns_are_pulled_back_by_the_stiffness_matrix(gravity):
    m, tiny = model(gravity=gravity), 1e-6
    by = np.random.default_rng(1).normal(size=m.state.rate.shape)
    force = []
    for sign in (1.0, -1.0):
        accel = accelerations(m, moved(m.state.turn, sign * tiny * by), np.zeros_like(by))
        force.append(joint_mass(m.bodies) @ accel.ravel())
    found = (force[0] - force[1]) / (2.0 * tiny)
    expected = -joint_stiffness(m.bodies, gravity) @ by.ravel()
    assert found == pytest.approx(expected, abs=1e-6 * np.abs(expected).max())


def test_mass_matrix_is_twice_the_kinetic_energy():
    m = model()
    rate = np.random.default_rng(4).normal(size=m.state.rate.shape)
    _, _, velocity, spin = plain_bodies(m.bodies, m.state.turn, rate)
    twice = m.bodies.mass @ np.sum(velocity**2, axis=1)
    twice += np.einsum('ni,nij,nj->', spin, m.bodies.inertia, spin)
    assert rate.ravel() @ joint_mass(m.bodies) @ rate.ravel() == pytest.approx(twice, rel=1e-12)


def test_modes_are_orthonormal_in_mass_and_diagonal_in_stiffness():
    m = model()
    modes = joint_modes(m.bodies, G, 6)
    turn = modes.turn.reshape(6, -1)
    assert turn @ joint_mass(m.bodies) @ turn.T == pytest.approx(np.eye(6), abs=1e-8)
    square = (2.0 * np.pi * modes.frequency) ** 2
    assert turn @ joint_stiffness(m.bodies, G) @ turn.T == pytest.approx(
        np.diag(square), abs=1e-6 * square[-1]
    )
    assert modes.momentum.reshape(6, -1) == pytest.approx((joint_mass(m.bodies) @ turn.T).T)
    assert np.all(np.diff(modes.frequency) >= 0.0)


def test_end_displacements_are_the_slope_of_the_places():
    m, tiny = model(), 1e-6
    by = np.random.default_rng(2).normal(size=m.state.rate.shape)
    ends = []
    for sign in (1.0, -1.0):
        m.state.turn[:] = moved(np.tile([1.0, 0, 0, 0], (len(by), 1)), sign * tiny * by)
        ends.append(m.node_positions)
    found = (ends[0] - ends[1]) / (2.0 * tiny)
    assert end_displacements(m.bodies, by[None])[0] == pytest.approx(found, abs=1e-8)


def test_one_segment_is_a_pendulum_on_a_spring():
    """A rod hinged at its middle: half of it swings, k = EI / L, softened by weight above."""
    stem = tapered_stem(2.0, [0.05, 0.05])
    inertia = np.pi / 64 * 0.05**4
    half = RHO * np.pi / 4 * 0.05**2
    swing = half / 3.0 + half * 0.05**2 / 16.0
    stiffness = E * inertia / 2.0
    for gravity in (0.0, 0.3):
        m = ArticulatedTree(stem, E, RHO, gravity=gravity, rayleigh=(0.0, 0.0))
        expected = np.sqrt((stiffness - gravity * half * 0.5) / swing) / (2.0 * np.pi)
        assert m.linear_modes(2)[0] == pytest.approx([expected, expected], rel=1e-9)
