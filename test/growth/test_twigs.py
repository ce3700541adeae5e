# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Twigs in groups that are alike."""

import numpy as np
import pytest

from tree_sway.growth.skeleton import Skeleton
from tree_sway.growth.twigs import add_twigs

UP_NORTH = np.array([0.0, np.cos(0.3), np.sin(0.3)])


def straight_branch(n_segments: int = 6) -> Skeleton:
    skeleton = Skeleton()
    skeleton.add(np.arange(n_segments + 1)[:, None] * UP_NORTH)
    return skeleton


def bent_branch() -> Skeleton:
    """Two segments to the north, then two straight up."""
    skeleton = Skeleton()
    skeleton.add(np.array([[0.0, 0, 0], [0, 1, 0], [0, 2, 0], [0, 2, 1], [0, 2, 2]]))
    return skeleton


def offsets(skeleton: Skeleton) -> np.ndarray:
    return np.array([twig.nodes[1] - twig.nodes[0] for twig in skeleton.shoots[1:]])


def test_every_node_from_the_first_has_one_on_each_side() -> None:
    skeleton = straight_branch()
    add_twigs(skeleton, 0, length=0.2, polar=0.7, sides=(0.0, np.pi), first_node=3)
    twigs = skeleton.shoots[1:]
    assert [twig.at for twig in twigs] == [3, 3, 4, 4, 5, 5, 6, 6]
    assert {twig.parent for twig in twigs} == {0}
    assert {twig.n_segments for twig in twigs} == {1}
    for twig in twigs:
        np.testing.assert_array_equal(twig.nodes[0], skeleton.shoots[0].nodes[twig.at])


def test_twigs_of_a_half_are_equal_and_the_outer_ones_shorter() -> None:
    skeleton = straight_branch()
    add_twigs(skeleton, 0, length=0.2, polar=0.7, sides=(0.0, np.pi), outer_ratio=0.5)
    ways = offsets(skeleton)
    right, left = ways[::2], ways[1::2]
    np.testing.assert_allclose(right[:3], np.tile(right[0], (3, 1)), atol=1e-12)
    np.testing.assert_allclose(right[3:], 0.5 * right[:3], atol=1e-12)
    np.testing.assert_allclose(np.linalg.norm(left, axis=1), [0.2] * 3 + [0.1] * 3)


def test_sides_are_right_and_left_of_the_branch_at_the_polar_angle() -> None:
    skeleton = straight_branch()
    add_twigs(skeleton, 0, length=1.0, polar=0.7, sides=(0.0, np.pi), outer_ratio=1.0)
    right, left = offsets(skeleton)[:2]
    assert right[0] > 0.5
    np.testing.assert_allclose(left, right * [-1.0, 1.0, 1.0], atol=1e-12)
    assert right @ UP_NORTH == pytest.approx(np.cos(0.7))


@pytest.mark.parametrize(('lift', 'sign'), [(0.8, 1.0), (-0.8, -1.0)])
def test_lift_turns_them_up_or_lets_them_hang_at_their_length(lift: float, sign: float) -> None:
    level, lifted = straight_branch(), straight_branch()
    for skeleton, amount in ((level, 0.0), (lifted, lift)):
        add_twigs(skeleton, 0, length=0.2, polar=0.7, sides=(0.0,), lift=amount)
    assert np.all(sign * (offsets(lifted) - offsets(level))[:, 2] > 0.0)
    np.testing.assert_allclose(
        np.linalg.norm(offsets(lifted), axis=1), np.linalg.norm(offsets(level), axis=1)
    )


def test_each_half_follows_its_own_direction() -> None:
    skeleton = bent_branch()
    add_twigs(skeleton, 0, length=1.0, polar=0.4, sides=(0.0,), outer_ratio=1.0)
    inner, _, outer, _ = offsets(skeleton)
    assert inner @ [0.0, 1.0, 0.0] == pytest.approx(np.cos(0.4))
    assert outer @ [0.0, 0.0, 1.0] == pytest.approx(np.cos(0.4))


def test_a_shoot_of_one_segment_can_carry_them() -> None:
    skeleton = straight_branch(1)
    add_twigs(skeleton, 0, length=0.2, polar=0.7, sides=(0.0, np.pi))
    assert [twig.at for twig in skeleton.shoots[1:]] == [1, 1]
