# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The tree's own figures, against hand counts."""

from __future__ import annotations

from dataclasses import replace
import math

from drawn_trees import branch_order
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tree_sway.core.tree.building import tree_from_segments


def test_figures_of_a_fork(fork):
    tree = fork()
    assert (tree.n_segments, tree.n_branches) == (11, 4)
    assert branch_order(tree).tolist() == [0, 1, 2, 1]
    assert tree.branch_parent.tolist() == [-1, 0, 1, 0]
    assert tree.subtree_end.tolist() == [4, 3, 3, 4]
    assert [tree.segments_of(b).stop for b in range(4)] == [4, 7, 9, 11]
    assert tree.branch_of_segment.tolist() == [0] * 4 + [1] * 3 + [2] * 2 + [3] * 2
    assert tree.length.sum() == pytest.approx(tree.branch_length.sum())


def test_volume_is_that_of_frustums(stem):
    cone = stem(length=3.0, base=0.2, tip=1e-12, cuts=7)
    assert cone.volume.sum() == pytest.approx(math.pi / 3 * 0.1**2 * 3.0)
    assert stem(length=3.0, base=0.2).volume.sum() == pytest.approx(math.pi * 0.1**2 * 3.0)


def test_height_is_that_of_the_highest_node_over_the_root(stem, sketch):
    assert stem(length=2.0, direction=(3.0, 0.0, 4.0)).height == pytest.approx(1.6)
    drawn = sketch()
    drawn.add(None, 0, (0, 0, 1), 1.0, 0.02, 0.01, 2)
    drawn.add(0, 2, (1, 0, -3), 2.0, 0.01, 0.01, 2)
    assert drawn.tree().height == pytest.approx(1.0)


def test_a_weeping_branch_has_its_length_along_the_wood(fork):
    tree = fork()
    own = tree.segments_of(1)
    chord = np.linalg.norm(tree.end[own][-1] - tree.start[own][0])
    assert tree.branch_length[1] > chord


def test_directions_and_frames_of_segments(fork):
    tree = fork()
    np.testing.assert_allclose(np.linalg.norm(tree.direction, axis=1), 1.0)
    np.testing.assert_allclose(tree.direction * tree.length[:, None], tree.end - tree.start)
    turned = Rotation.from_quat(tree.rest_frame[:, [1, 2, 3, 0]]).apply([1.0, 0.0, 0.0])
    np.testing.assert_allclose(turned, tree.direction, atol=1e-12)
    for array in (tree.direction, tree.rest_frame, tree.place_on_parent):
        assert not array.flags.writeable


def test_the_foot_of_a_segment_on_its_parent():
    tree = tree_from_segments(
        [[0, 0, 0], [0, 0, 0.5], [0, 0.1, 2.5], [0, 0, 2]],
        [[0, 0, 2], [1, 0, 0.5], [0, 1, 2.5], [0, 0, 3]],
        [0.1, 0.02, 0.02, 0.08],
        parent=[-1, 0, 0, 0],
        branch=[0, 1, 2, 0],
    )
    by_source = dict(zip(tree.source_index.tolist(), tree.place_on_parent.tolist(), strict=True))
    assert by_source == pytest.approx({0: 1.0, 1: 0.25, 2: 1.0, 3: 1.0})


def test_the_arrays_that_a_tree_is_made_of_stay_free(fork):
    tree = fork()
    start = tree.start.copy()
    made = replace(tree, start=start)
    start[0] = 9.0
    assert not np.shares_memory(made.start, start)
    assert made.start[0, 0] == tree.start[0, 0]
    with pytest.raises(ValueError, match='read-only'):
        made.start[0] = 1.0
