# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Rotations of the hot path: the axioms of a group, and scipy as the judge."""

from __future__ import annotations

from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from tree_sway_lab.full.rotation import (
    half_angle,
    product,
    quaternion,
    rotated,
    turned,
)

component = st.floats(-3.0, 3.0)
vectors = st.tuples(component, component, component)
IDENTITY = (1.0, 0.0, 0.0, 0.0)


def inverse(q):
    return (q[0], -q[1], -q[2], -q[3])


@settings(deadline=None)
@given(vectors, vectors, vectors)
def test_the_product_is_associative(a, b, c):
    p, q, r = quaternion(*a), quaternion(*b), quaternion(*c)
    one, other = product(*product(*p, *q), *r), product(*p, *product(*q, *r))
    assert one == pytest.approx(other, abs=1e-12)


@settings(deadline=None)
@given(vectors)
def test_there_is_an_identity_and_an_inverse(a):
    q = quaternion(*a)
    assert product(*q, *IDENTITY) == pytest.approx(q)
    assert product(*IDENTITY, *q) == pytest.approx(q)
    assert product(*q, *inverse(q)) == pytest.approx(IDENTITY, abs=1e-12)
    assert quaternion(*(-np.array(a))) == pytest.approx(inverse(q), abs=1e-12)


@settings(deadline=None)
@given(vectors, vectors, vectors)
def test_a_product_turns_as_one_after_the_other(a, b, v):
    p, q = quaternion(*a), quaternion(*b)
    assert rotated(*product(*p, *q), *v) == pytest.approx(rotated(*p, *rotated(*q, *v)), abs=1e-11)


@settings(deadline=None)
@given(vectors, vectors)
def test_scipy_agrees(a, v):
    judge = Rotation.from_rotvec(a)
    assert rotated(*quaternion(*a), *v) == pytest.approx(judge.apply(v), abs=1e-11)
    w, x, y, z = quaternion(*a)
    assert np.abs(np.dot(judge.as_quat(), (x, y, z, w))) == pytest.approx(1.0, abs=1e-12)


@settings(deadline=None)
@given(vectors, vectors)
def test_lengths_and_angles_are_kept(a, v):
    for out in (rotated(*quaternion(*a), *v), turned(*a, *v)):
        assert np.linalg.norm(out) == pytest.approx(np.linalg.norm(v), abs=1e-11)
        assert np.dot(out, a) == pytest.approx(np.dot(v, a), abs=1e-10)


@settings(deadline=None)
@given(vectors, vectors)
def test_cayleys_map_is_a_rotation_that_its_opposite_undoes(a, v):
    back = turned(*(-np.array(a)), *turned(*a, *v))
    assert back == pytest.approx(v, abs=1e-12)
    size = np.linalg.norm(a)
    tangent = size / 2.0 + size**3 / 24.0 + size**5 / 240.0 + 17.0 * size**7 / 40320.0
    angle = 2.0 * np.arctan(tangent)
    judge = Rotation.from_rotvec(np.array(a) / max(size, 1e-300) * angle)
    assert turned(*a, *v) == pytest.approx(judge.apply(v), abs=1e-11)


@pytest.mark.parametrize(('angle', 'share'), [(0.3, 1e-8), (1.0, 1e-4), (2.0, 0.02)])
def test_cayleys_map_turns_by_nearly_the_angle(angle, share):
    x, y, _ = turned(0.0, 0.0, angle, 1.0, 0.0, 0.0)
    assert np.arctan2(y, x) == pytest.approx(angle, rel=share)


@settings(deadline=None)
@given(st.floats(0.0, 9.0))
def test_half_angles_are_right_on_both_sides_of_the_series(t):
    c, s = half_angle(t)
    root = np.sqrt(t)
    assert c == pytest.approx(np.cos(root), abs=3e-13)
    assert s == pytest.approx(np.sinc(root / np.pi), abs=3e-13)


def test_no_rotation_is_exactly_none():
    assert quaternion(0.0, 0.0, 0.0) == IDENTITY
    assert rotated(*IDENTITY, 0.1, 0.2, 0.3) == (0.1, 0.2, 0.3)
    assert turned(0.0, 0.0, 0.0, 0.1, 0.2, 0.3) == (0.1, 0.2, 0.3)
