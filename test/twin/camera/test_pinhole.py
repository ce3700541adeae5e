# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The camera against closed forms."""

from __future__ import annotations

import numpy as np
import pytest

from tree_sway.twin.camera import Camera, looking

SOUTH = Camera(
    np.array([0.0, -10.0, 1.5]), looking(0.0, 0.0, 0.0), 800.0, np.array([640.0, 360.0])
)
"""It stands 10 m south of the origin, and looks north."""


def test_east_is_right_and_up_is_up() -> None:
    points = np.array([[0.0, 0.0, 1.5], [1.0, 0.0, 1.5], [0.0, 0.0, 2.5], [0.0, 10.0, 2.5]])
    wanted = [[640.0, 360.0], [720.0, 360.0], [640.0, 280.0], [640.0, 320.0]]
    np.testing.assert_allclose(SOUTH.project(points), wanted)
    np.testing.assert_allclose(SOUTH.depth(points), [10.0, 10.0, 10.0, 20.0])


def test_a_point_behind_is_not_seen() -> None:
    assert np.isnan(SOUTH.project(np.array([[0.0, -11.0, 1.0]]))).all()


def test_it_looks_where_it_is_told() -> None:
    """To the west of it, half a right angle up, turned by a right angle clockwise."""
    camera = SOUTH._replace(axes=looking(np.pi * 1.5, np.pi / 4, np.pi / 2))
    np.testing.assert_allclose(camera.axes @ camera.axes.T, np.eye(3), atol=1e-12)
    at = camera.position + np.array([-5.0, 0.0, 5.0])
    np.testing.assert_allclose(camera.project(at[None]), [[640.0, 360.0]], atol=1e-9)
    # What is north of there, to the right of a level camera, is now above the middle.
    x, y = camera.project((at + np.array([0.0, 1.0, 0.0]))[None])[0]
    assert x == pytest.approx(640.0)
    assert y < 360.0


def test_slopes_are_those_of_differences() -> None:
    rng = np.random.default_rng(1)
    camera = SOUTH._replace(axes=looking(0.1, 0.3, 0.05))
    points = rng.normal(size=(5, 3)) + np.array([0.0, 0.0, 4.0])
    slopes = camera.slopes(points)
    for axis in range(3):
        step = 1e-5 * np.eye(3)[axis]
        change = (camera.project(points + step) - camera.project(points - step)) / 2e-5
        np.testing.assert_allclose(slopes[:, :, axis], change, rtol=1e-6, atol=1e-5)
