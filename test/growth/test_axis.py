# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Headings, and the lines that shoots draw."""

from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest

from tree_sway.growth.axis import aim, direction_of, grow_axis, heading_of

ANGLE = st.floats(-3.1, 3.1)
ELEVATION = st.floats(-1.5, 1.5)


@given(azimuth=ANGLE, elevation=ELEVATION)
def test_heading_and_direction_are_inverse(azimuth: float, elevation: float) -> None:
    assert heading_of(direction_of(azimuth, elevation)) == pytest.approx((azimuth, elevation))


@given(azimuth=ANGLE, elevation=st.floats(-1.57, 1.57), polar=st.floats(0.0, 3.0), side=ANGLE)
def test_aim_keeps_the_angle_from_the_axis(
    azimuth: float, elevation: float, polar: float, side: float
) -> None:
    axis = direction_of(azimuth, elevation)
    way = aim(axis, polar, side)
    assert np.linalg.norm(way) == pytest.approx(1.0)
    assert way @ axis == pytest.approx(np.cos(polar))


def test_aim_knows_right_and_up() -> None:
    north = np.array([0.0, 1.0, 0.0])
    np.testing.assert_allclose(aim(north, np.pi / 2, 0.0), [1, 0, 0], atol=1e-15)
    np.testing.assert_allclose(aim(north, np.pi / 2, np.pi / 2), [0, 0, 1], atol=1e-15)


@given(length=st.floats(0.01, 10.0), n=st.integers(1, 12), seed=st.integers(0, 1000))
def test_a_shoot_has_its_length_and_its_headings(length: float, n: int, seed: int) -> None:
    nodes = grow_axis(np.ones(3), 0.4, (1.0, -0.5), length, n, np.random.default_rng(seed))
    steps = np.diff(nodes, axis=0)
    assert nodes.shape == (n + 1, 3)
    assert np.linalg.norm(steps, axis=1).sum() == pytest.approx(length)
    assert heading_of(steps[0]) == pytest.approx((0.4, 1.0))
    if n > 1:
        assert heading_of(steps[-1]) == pytest.approx((0.4, -0.5))


def test_a_hanging_shoot_ends_above_the_floor() -> None:
    rng = np.random.default_rng(0)
    nodes = grow_axis(np.array([0.0, 0.0, 1.0]), 0.0, (-1.0, -1.5), 2.0, 8, rng, floor=0.3)
    assert 2 < len(nodes) < 9
    assert nodes[:, 2].min() >= 0.3
