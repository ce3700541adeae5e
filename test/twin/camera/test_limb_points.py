# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Points are matched to the wood that is seen, and move as the simulator places it."""

from __future__ import annotations

import numpy as np
import pytest

from tree_sway.core.run import SwaySimulator
from tree_sway.core.scene import make_simulator
from tree_sway.core.tree import ends_of_poses, tree_from_segments
from tree_sway.growth import grow
from tree_sway.twin.camera import Camera, looking
from tree_sway.twin.camera.limb_points import LimbPoints, matched_points

CAMERA = Camera(
    np.array([0.0, -12.0, 1.5]), looking(0.0, 0.2, 0.0), 900.0, np.array([640.0, 360.0])
)


@pytest.fixture(scope='module')
def simulator() -> SwaySimulator:
    return make_simulator(grow('spruce', 6.0, rng=np.random.default_rng(3)))


def test_points_on_the_stem_are_on_the_stem(simulator: SwaySimulator) -> None:
    tree, poses = simulator.tree, simulator.place()
    stem = np.arange(int(tree.branch_first[1]))
    image = CAMERA.project(ends_of_poses(poses[stem], 0.5 * tree.length[stem])[1])
    found = matched_points(tree, poses, CAMERA, image)
    low = found.row < 3
    assert low.any()
    np.testing.assert_array_equal(found.segment[low], stem[found.row[low]])
    np.testing.assert_allclose(found.away[low], 0.5 * tree.length[found.segment[low]], rtol=0.1)


def test_points_of_the_sky_are_left_out(simulator: SwaySimulator) -> None:
    image = np.array([[5.0, 5.0], [1275.0, 10.0]])
    found = matched_points(simulator.tree, simulator.place(), CAMERA, image)
    assert len(found.row) == 0
    assert found.slopes(simulator).shape[0] == 0


def test_where_limbs_cross_nothing_is_matched() -> None:
    """One limb rises towards the camera, another one sinks away from it."""
    tree = tree_from_segments(
        start=np.array([[0, 0, 0], [0, 0, 2], [0, 0, 2], [0, 0, 3]], dtype=float),
        end=np.array([[0, 0, 2], [0, 0, 3], [1.5, -1.5, 3], [1.5, 1.5, 2]], dtype=float),
        diameter=np.array([0.1, 0.08, 0.04, 0.04]),
    )
    poses = make_simulator(tree).place()
    start, end = ends_of_poses(poses, tree.length)
    first, last = CAMERA.project(start), CAMERA.project(end)
    limbs = [int(np.flatnonzero(np.isclose(end[:, 1], y, atol=0.3))[0]) for y in (-1.5, 1.5)]
    (a, b), (c, d) = ((first[k], last[k]) for k in limbs)
    share = float(np.linalg.solve(np.stack([b - a, c - d], axis=1), c - a)[0])
    crossing, lonely = a + share * (b - a), a + 0.95 * (b - a)
    assert 0.0 < share < 0.9
    found = matched_points(tree, poses, CAMERA, np.array([crossing, lonely]))
    np.testing.assert_array_equal(found.row, [1])
    np.testing.assert_array_equal(found.segment, limbs[:1])


def test_slopes_are_those_of_place(simulator: SwaySimulator) -> None:
    points = LimbPoints(np.array([2, 40, 90]), np.array([0.1, 0.02, 0.05]), np.arange(3))
    slopes = points.slopes(simulator)
    shapes = simulator.banks[0].oscillators.shapes
    rng = np.random.default_rng(2)
    eta = rng.normal(size=shapes.shape[1])
    turned = shapes @ eta
    eta *= 1e-5 / np.abs(turned).max()
    rest = points.at(simulator.place_rotations(0.0 * turned))
    moved = points.at(simulator.place_rotations(np.ascontiguousarray(shapes @ eta)))
    np.testing.assert_allclose(moved - rest, slopes @ eta, rtol=1e-3, atol=1e-9)
