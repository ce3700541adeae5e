# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""From poses back to segments, and to the picture plane."""

from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
import numpy as np
import pytest

from tree_sway.core.tree.building import tree_from_segments
from tree_sway.core.tree.segment_frame import ends_of_poses
from tree_sway.growth.builtin import builtin_tree
from tree_sway.pictures.tree_drawing import ELEVATION, seen

POINTS = arrays(np.float64, (5, 3), elements=st.floats(-10, 10))


def test_rest_poses_give_the_tree_back() -> None:
    tree = builtin_tree('goldcrest')
    poses = tree.rest_poses
    np.testing.assert_allclose(np.linalg.norm(poses[:, 3:], axis=1), 1.0, rtol=1e-12)
    start, end = ends_of_poses(poses, tree.length)
    np.testing.assert_array_equal(start, tree.start)
    np.testing.assert_allclose(end, tree.end, atol=1e-12)


@pytest.mark.parametrize('axis', [*np.eye(3), *-np.eye(3)])
def test_rest_poses_of_segments_along_every_axis(axis: np.ndarray) -> None:
    start = np.ones((1, 3))
    tree = tree_from_segments(start, start + 2.0 * axis, [0.1])
    end = ends_of_poses(tree.rest_poses, tree.length)[1]
    np.testing.assert_allclose(end, start + 2.0 * axis, atol=1e-12)


def test_a_quarter_turn_about_z_takes_x_to_y() -> None:
    half = np.sqrt(0.5)
    end = ends_of_poses([[1.0, 2.0, 3.0, 0.0, 0.0, half, half]], [2.0])[1]
    np.testing.assert_allclose(end, [[1.0, 4.0, 3.0]], atol=1e-12)


@given(points=POINTS)
def test_projection_keeps_distances(points: np.ndarray) -> None:
    shown = seen(points)
    np.testing.assert_allclose(
        np.linalg.norm(shown[1:] - shown[0], axis=1),
        np.linalg.norm(points[1:] - points[0], axis=1),
        atol=1e-9,
    )


def test_from_the_south_and_above_east_is_right_and_north_is_away_and_higher() -> None:
    sine, cosine = np.sin(ELEVATION), np.cos(ELEVATION)
    expected = [[1, 0, 0], [0, sine, cosine], [0, cosine, -sine]]
    np.testing.assert_allclose(seen(np.eye(3)), expected, atol=1e-12)
