# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Segments cut in pieces: the same wood, and what sits on it stays."""

import numpy as np
import pytest
from tree_sway_lab.example_trees import forked_tree
from tree_sway_lab.frame.frame import frame_model
from tree_sway_lab.segments.refinement import refined

from tree_sway.core.tree.building import tree_from_segments


def with_arms(*places):
    """Make a stem of one segment, a metre tall, and an arm at each height."""
    start = [[0.0, 0.0, 0.0], *([0.0, 0.0, z] for z in places)]
    end = [[0.0, 0.0, 1.0], *([0.5, 0.1 * k, z] for k, z in enumerate(places))]
    width = [[0.1, 0.06], *([0.02, 0.01] for _ in places)]
    parent = [-1] + [0] * len(places)
    return tree_from_segments(start, end, width, parent=parent, branch=np.arange(len(start)))


def test_one_piece_is_the_tree_itself():
    tree = forked_tree(0.5, 0.6, generations=2)
    assert refined(tree, 1) is tree


def test_places_along_the_parent():
    tree = with_arms(0.25, 0.5, 1.0)
    assert tree.place_on_parent == pytest.approx([1.0, 0.25, 0.5, 1.0])


@pytest.mark.parametrize(('pieces', 'seats'), [(2, [0, 1, 1]), (4, [1, 2, 3]), (3, [0, 1, 2])])
def test_a_branch_sits_on_the_piece_it_starts_at(pieces, seats):
    tree = with_arms(0.3, 0.5, 1.0)
    cut = refined(tree, pieces)
    assert cut.n_segments == 4 * pieces
    first = cut.branch_first[1:-1]
    assert cut.segment_parent[first].tolist() == seats
    assert cut.start[first] == pytest.approx(tree.start[1:])


@pytest.mark.parametrize('pieces', [2, 5])
def test_pieces_join_taper_on_and_remember_their_source(pieces):
    tree = forked_tree(0.65, 0.6, generations=3)
    cut = refined(tree, pieces)
    inner = np.setdiff1d(np.arange(1, cut.n_segments), cut.branch_first[:-1])
    assert cut.start[inner] == pytest.approx(cut.end[cut.segment_parent[inner]])
    assert cut.base_diameter[inner] == pytest.approx(cut.tip_diameter[cut.segment_parent[inner]])
    assert cut.length == pytest.approx(np.repeat(tree.length / pieces, pieces))
    assert cut.source_index.tolist() == np.repeat(tree.source_index, pieces).tolist()
    assert cut.volume.reshape(-1, pieces).sum(axis=1) == pytest.approx(tree.volume)
    assert cut.branch_parent.tolist() == tree.branch_parent.tolist()


def test_twice_cut_is_cut_in_the_product():
    tree = forked_tree(0.4, 0.35, generations=3)
    twice, once = refined(refined(tree, 2), 3), refined(tree, 6)
    assert twice.end == pytest.approx(once.end)
    assert twice.segment_parent.tolist() == once.segment_parent.tolist()


def test_elements_and_pieces_are_the_same_cut():
    tree = forked_tree(0.5, 0.6, generations=2)
    by_element = frame_model(tree, 8e9, 900.0, 9.81, subdivisions=3).frequencies(5)
    by_piece = frame_model(refined(tree, 3), 8e9, 900.0, 9.81, subdivisions=1).frequencies(5)
    assert by_piece == pytest.approx(by_element, rel=1e-8)
