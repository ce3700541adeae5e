# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Places on a tree by height, branch or segment, and how they move."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tree_sway.core.scene.make import make_simulator
from tree_sway.core.tree.segment_frame import ends_of_poses
from tree_sway.errors import ParameterError
from tree_sway.growth.builtin import builtin_tree
from tree_sway.twin.sensor_place import place_motion, place_on, tip_slopes, turn_between

TREE = builtin_tree('broadleaf')


def test_a_height_is_found_on_the_stem() -> None:
    height = 0.4 * TREE.end[: TREE.branch_first[1], 2].max()
    segment, along, *_ = place_on(TREE, str(height))
    assert TREE.branch_of_segment[segment] == 0
    at = TREE.start[segment] + along * (TREE.end[segment] - TREE.start[segment])
    assert at[2] - TREE.start[0, 2] == pytest.approx(height)


def test_a_share_of_a_branch_is_found_by_length() -> None:
    name = TREE.branch_names[3]
    first, last = TREE.branch_first[3], TREE.branch_first[4]
    segment, along, *_ = place_on(TREE, f'{name}:0.5')
    before = TREE.length[first:segment].sum() + along * TREE.length[segment]
    assert before == pytest.approx(0.5 * TREE.length[first:last].sum())


def test_a_segment_is_taken_in_its_middle() -> None:
    assert place_on(TREE, 'segment:7') == (7, 0.5, None, False)


@pytest.mark.parametrize(
    ('where', 'what'),
    [
        ('nowhere', 'is no place on a tree'),
        ('', 'is no place on a tree'),
        ('nan', 'is no place on a tree'),
        ('999', 'the stem has no height'),
        ('-1', 'the stem has no height'),
        ('stm:0.5', "no branch 'stm'"),
        (f'{TREE.branch_names[1]}:1.5', 'of a branch'),
        ('segment:1e9', 'no segment'),
        ('segment:1.5', 'no segment'),
    ],
)
def test_other_places_are_refused_with_a_cure(where: str, what: str) -> None:
    with pytest.raises(ParameterError, match=what) as caught:
        place_on(TREE, where)
    assert caught.value.cure


def test_the_bearing_to_which_a_sensor_faces_may_follow() -> None:
    place = place_on(TREE, 'segment:7 facing 120')
    assert place[:3] == (7, 0.5, pytest.approx(np.radians(-30.0)))
    assert place_on(TREE, 'segment:7 facing W') == place_on(TREE, 'segment:7 facing 270')
    for bearing in ('north', '1000', ''):
        with pytest.raises(ParameterError, match='facing'):
            place_on(TREE, f'segment:7 facing {bearing}')


def test_the_motion_of_a_place_is_that_of_its_pose() -> None:
    sim = make_simulator(TREE, model=12)
    place = place_on(TREE, f'{TREE.branch_names[2]}:0.7')
    motion = place_motion(sim, place)
    eta = 1e-3 * np.random.default_rng(1).normal(size=12) / np.arange(1, 13)
    rest = sim.place_rotations(0.0 * sim.rotations())
    moved = sim.place_rotations(np.ascontiguousarray(sim.banks[0].oscillators.shapes @ eta))
    rows = slice(place.segment, place.segment + 1)
    away = place.along * TREE.length[place.segment]
    shift = ends_of_poses(moved[rows], [away])[1] - ends_of_poses(rest[rows], [away])[1]
    turn = (
        Rotation.from_quat(moved[place.segment, 3:])
        * Rotation.from_quat(rest[place.segment, 3:]).inv()
    )
    size = np.abs(shift).max()
    np.testing.assert_allclose(motion.displacement @ eta, shift[0], atol=0.02 * size)
    np.testing.assert_allclose(
        motion.rotation @ eta, turn.as_rotvec(), atol=0.02 * np.abs(turn.as_rotvec()).max()
    )


def test_turns_are_those_of_scipy() -> None:
    before, after = Rotation.random(50, rng=1), Rotation.random(50, rng=2)
    found = turn_between(before.as_quat(), after.as_quat())
    np.testing.assert_allclose(found, (after * before.inv()).as_rotvec(), atol=1e-9)


def test_tips_move_as_places_at_their_ends_do() -> None:
    sim = make_simulator(TREE, model=12)
    slopes = tip_slopes(sim)
    assert slopes.shape == (TREE.n_branches, 3, 12)
    for branch in (0, 3, TREE.n_branches - 1):
        at_tip = place_motion(sim, place_on(TREE, f'{TREE.branch_names[branch]}:1.0'))
        np.testing.assert_allclose(slopes[branch], at_tip.displacement, atol=1e-6)
