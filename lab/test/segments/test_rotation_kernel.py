# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Rotations against scipy, and torques against the work they do."""

from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from tree_sway_lab.segments import rotation_kernel as kernel

AXIS = (0.6, 0.0, 0.8)
SEEDS = st.integers(0, 10**6)


def vector(seed, size=2.5):
    """Draw a rotation vector of any size up to this."""
    rng = np.random.default_rng(seed)
    v = rng.normal(size=3)
    return tuple(v / np.linalg.norm(v) * size * rng.uniform())


def quaternion(v):
    q = np.empty(4)
    kernel.turn_on(np.array([1.0, 0.0, 0.0, 0.0]), tuple(v), q)
    return q


def turned(q, v):
    out = np.empty(4)
    kernel.turn_on(q, tuple(v), out)
    return out


def test_vector_algebra_is_numpys():
    rng = np.random.default_rng(0)
    a, b = tuple(rng.normal(size=3)), tuple(rng.normal(size=3))
    m, n, out = rng.normal(size=(3, 3)), rng.normal(size=(3, 3)), np.empty((3, 3))
    assert kernel.plus(a, b, -2.0) == pytest.approx(np.array(a) - 2.0 * np.array(b))
    assert kernel.dot(a, b) == pytest.approx(np.dot(a, b))
    assert kernel.cross(a, b) == pytest.approx(np.cross(a, b))
    assert kernel.times(m, a) == pytest.approx(m @ a)
    assert kernel.times_transposed(m, a) == pytest.approx(m.T @ a)
    kernel.product(m, n, out)
    assert out == pytest.approx(m @ n)
    kernel.cross_columns(a, m, out)
    assert out == pytest.approx(np.cross(a, m.T).T)
    kernel.inverse(m, out)
    assert out @ m == pytest.approx(np.eye(3), abs=1e-12)
    rows = np.zeros((2, 3))
    kernel.write(rows, 1, a)
    assert kernel.read(rows, 1) == a
    assert not rows[0].any()


@settings(deadline=None)
@given(SEEDS, st.floats(0.0, 3.1))
def test_quaternions_are_scipys(seed, size):
    v = vector(seed, size)
    expected = Rotation.from_rotvec(v)
    q, matrix = quaternion(v), np.empty((3, 3))
    kernel.matrix_of(q, matrix)
    assert matrix == pytest.approx(expected.as_matrix(), abs=1e-14)
    assert kernel.logarithm(q) == pytest.approx(v, abs=1e-12)
    assert kernel.logarithm(-q) == pytest.approx(v, abs=1e-12), 'the same rotation'


@settings(deadline=None)
@given(SEEDS)
def test_turning_on_is_in_the_bodys_own_axes(seed):
    first, then = vector(seed), vector(seed + 1)
    expected = Rotation.from_rotvec(first) * Rotation.from_rotvec(then)
    q = turned(quaternion(first), then)
    assert np.linalg.norm(q) == pytest.approx(1.0, abs=1e-15)
    matrix = np.empty((3, 3))
    kernel.matrix_of(q, matrix)
    assert matrix == pytest.approx(expected.as_matrix(), abs=1e-13)


@pytest.mark.parametrize('size', [0.0, 1e-12, 0.9e-3, 1.1e-3, 2.0 * np.pi - 1e-3])
def test_small_and_nearly_whole_turns(size):
    q = quaternion(size * np.array(AXIS))
    expected = Rotation.from_rotvec(size * np.array(AXIS)).as_quat()
    assert q[1:] == pytest.approx(expected[:3], rel=1e-13, abs=1e-25)
    short = size if size < np.pi else size - 2.0 * np.pi
    assert kernel.logarithm(q) == pytest.approx(short * np.array(AXIS), rel=1e-9, abs=1e-25)


def test_the_result_may_overwrite_its_argument():
    q = quaternion((0.1, 0.2, 0.3))
    expected = turned(q, (0.5, -0.4, 0.3))
    kernel.turn_on(q, (0.5, -0.4, 0.3), q)
    assert q == pytest.approx(expected, abs=0.0)


@pytest.mark.parametrize('seed', range(6))
def test_twist_and_its_gradient(seed, differences):
    q = quaternion(vector(seed))
    angle, gradient = kernel.twist_of(q, AXIS)
    found = differences(lambda v: kernel.twist_of(turned(q, v), AXIS)[0], np.zeros(3))
    assert gradient == pytest.approx(found, abs=1e-9)
    assert kernel.twist_of(-q, AXIS)[0] == pytest.approx(angle)


def test_twist_of_a_pure_twist_and_of_a_pure_swing():
    axis = np.array(AXIS)
    assert kernel.twist_of(quaternion(1.2 * axis), AXIS)[0] == pytest.approx(1.2)
    assert kernel.twist_of(quaternion((0.0, 1.2, 0.0)), AXIS)[0] == pytest.approx(0.0, abs=1e-15)
    both = turned(quaternion((0.0, 0.7, 0.0)), 0.5 * axis)
    assert kernel.twist_of(both, AXIS)[0] == pytest.approx(0.5)


@pytest.mark.parametrize('size', [1e-6, 0.9e-2, 1.1e-2, 1.0, 3.0])
def test_held_torque_works_as_a_constant_one(size, differences):
    """Its work on a small turn more is a constant torque's on the change of the vector."""
    torque = np.array([1.0, -2.0, 0.5])
    v = size * np.array(vector(3, 1.0)) / np.linalg.norm(vector(3, 1.0))
    q = quaternion(v)
    work = differences(lambda more: np.dot(torque, kernel.logarithm(turned(q, more))), np.zeros(3))
    assert kernel.held_torque(tuple(v), tuple(torque)) == pytest.approx(work, abs=1e-8)
    assert kernel.held_torque((0.0, 0.0, 0.0), tuple(torque)) == tuple(torque)
