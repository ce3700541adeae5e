# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""From segments in any order to a tree: what is inferred, how it is ordered, what is refused."""

from __future__ import annotations

from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
import pytest

from tree_sway.core.tree.building import tree_from_segments
from tree_sway.errors import TreeError

seeds = st.integers(0, 10**6)
sizes = st.integers(1, 40)

#: A stem of two segments and a side shoot on the first one's end.
START = np.array([[0, 0, 0], [0, 0, 1], [0, 0, 1.0]])
END = np.array([[0, 0, 1], [0, 0, 2], [1, 0, 1.0]])
THICK = np.array([0.1, 0.08, 0.02])


def subtree(parents, of):
    """List a branch and all it carries, by asking every branch for its ancestors."""
    found = set()
    for branch in range(len(parents)):
        ancestor = branch
        while ancestor not in (-1, of):
            ancestor = parents[ancestor]
        if ancestor == of:
            found.add(branch)
    return found


@given(seeds, sizes)
@settings(max_examples=60, deadline=None)
def test_parents_are_found_from_nodes_in_any_order(random_tree, seed, n):
    start, end, diameter, parent = random_tree(seed, n)
    tree = tree_from_segments(start, end, diameter)
    place = tree.source_index
    assert sorted(place) == list(range(n))
    assert np.array_equal(tree.start, start[place])
    assert np.array_equal(tree.tip_diameter, diameter[place])
    found = np.where(tree.segment_parent < 0, -1, place[tree.segment_parent])
    assert np.array_equal(found, parent[place])


@given(seeds, sizes)
@settings(max_examples=60, deadline=None)
def test_the_thickest_child_goes_on_with_the_branch(random_tree, seed, n):
    start, end, diameter, parent = random_tree(seed, n)
    tree = tree_from_segments(start, end, diameter, parent=parent)
    branch = np.empty(n, dtype=int)
    branch[tree.source_index] = tree.branch_of_segment
    for segment in range(n):
        children = np.flatnonzero(parent == segment)
        if len(children):
            continuation = children[np.argmax(diameter[children])]
            assert branch[continuation] == branch[segment]
            assert len(set(branch[children])) == len(children)


@given(seeds, sizes)
@settings(max_examples=60, deadline=None)
def test_order_is_depth_first_and_subtrees_are_slices(random_tree, seed, n):
    tree = tree_from_segments(*random_tree(seed, n)[:3])
    first, parents = tree.branch_first, tree.branch_parent
    assert first[0] == 0
    assert first[-1] == n
    assert parents[0] == -1
    assert (parents[1:] < np.arange(1, tree.n_branches)).all()
    for branch in range(tree.n_branches):
        own = np.arange(first[branch], first[branch + 1])
        assert np.array_equal(tree.segment_parent[own[1:]], own[:-1])
        carried = range(branch, int(tree.subtree_end[branch]))
        assert subtree(parents, branch) == set(carried)
        seat = tree.segment_parent[own[0]]
        assert seat < own[0]
        assert parents[branch] == (-1 if seat < 0 else tree.branch_of_segment[seat])


@given(seeds, st.integers(2, 25))
@settings(max_examples=30, deadline=None)
def test_the_order_of_the_input_does_not_matter(random_tree, seed, n):
    start, end, diameter, _ = random_tree(seed, n)
    shuffle = np.random.default_rng(seed + 1).permutation(n)
    one = tree_from_segments(start, end, diameter)
    other = tree_from_segments(start[shuffle], end[shuffle], diameter[shuffle])
    assert np.array_equal(one.branch_parent[0], other.branch_parent[0])
    assert sorted(one.branch_length) == pytest.approx(sorted(other.branch_length))
    assert {tuple(p) for p in one.end} == {tuple(p) for p in other.end}


@given(seeds, st.integers(2, 30))
@settings(max_examples=30, deadline=None)
def test_a_tree_builds_again_from_itself(random_tree, seed, n):
    tree = tree_from_segments(*random_tree(seed, n)[:3])
    again = tree_from_segments(
        tree.start,
        tree.end,
        np.stack([tree.base_diameter, tree.tip_diameter], axis=1),
        parent=tree.segment_parent,
        branch=tree.branch_of_segment,
        branch_names=tree.branch_names,
    )
    assert np.array_equal(again.source_index, np.arange(n))
    assert np.array_equal(again.subtree_end, tree.subtree_end)
    assert again.branch_names == tree.branch_names


def test_siblings_stand_from_base_to_tip_of_their_parent():
    nodes = np.array([[0, 0, z] for z in range(5)], dtype=float)
    side = nodes[1:4] + np.array([0.5, 0, 0])
    start = np.vstack([nodes[:-1], nodes[[3, 1, 2]]])
    end = np.vstack([nodes[1:], side[[2, 0, 1]]])
    tree = tree_from_segments(start, end, [0.1] * 4 + [0.02] * 3)
    assert tree.start[tree.branch_first[1:-1], 2].tolist() == [1, 2, 3]


def test_nodes_need_not_meet_exactly_but_nearly():
    close = START + np.array([[0, 0, 0], [0, 0, 1e-5], [1e-5, 0, 0]])
    assert tree_from_segments(close, END, THICK).segment_parent.tolist() == [-1, 0, 0]
    with pytest.raises(TreeError, match='2 roots'):
        tree_from_segments(START + np.array([[0], [0], [0.01]]), END, THICK)


def test_a_root_far_shorter_than_the_tree_is_not_its_own_parent():
    start, end = [[0, 0, 0], [0, 0, 5e-4]], [[0, 0, 5e-4], [0, 0, 10]]
    assert tree_from_segments(start, end, [0.1, 0.1]).segment_parent.tolist() == [-1, 0]


def test_a_shoot_from_the_middle_of_a_segment_begins_a_branch():
    start = START.copy()
    start[2] = [0, 0, 0.2]
    tree = tree_from_segments(start, END, [0.1, 0.01, 0.09], parent=[-1, 0, 0])
    assert tree.n_branches == 2
    assert tree.source_index.tolist() == [0, 1, 2]


def test_names_follow_sorted_keys_or_depth_first_order():
    given_names = tree_from_segments(
        START, END, THICK, branch=[7, 7, 3], branch_names=['shoot', 'trunk']
    )
    assert given_names.branch_names == ('trunk', 'shoot')
    assert given_names.segment_names == ('trunk/0', 'trunk/1', 'shoot/0')
    assert tree_from_segments(START, END, THICK).branch_names == ('stem', 'b1')


def test_nothing_of_a_tree_can_be_written(random_tree):
    tree = tree_from_segments(*random_tree(3)[:3])
    arrays = [a for a in vars(tree).values() if isinstance(a, np.ndarray)]
    arrays += [tree.length, tree.volume, tree.branch_length, tree.branch_of_segment]
    assert len(arrays) == 13
    for array in arrays:
        with pytest.raises(ValueError, match='read-only'):
            array[0] = 0


def test_the_input_stays_the_callers_own():
    start = START.copy()
    tree = tree_from_segments(start, END, THICK)
    start[:] = np.nan
    assert np.isfinite(tree.start).all()


@pytest.mark.parametrize(
    ('change', 'message'),
    [
        ({'start': [], 'end': [], 'diameter': []}, 'without segments; give at least one'),
        ({'end': END[:2]}, r'end \(2, 3\) .* do not match; give \(n, 3\)'),
        ({'diameter': [0.1, 0.1]}, 'do not match'),
        ({'start': START[:, :2]}, 'do not match'),
        ({'start': np.where(START == 1, np.nan, START)}, 'row 1: a number that is not finite'),
        ({'diameter': [0.1, 0.1, np.inf]}, 'row 2: a number that is not finite'),
        ({'end': [END[0], START[1], END[2]]}, r'row 1: zero length \(.*remove the segment'),
        ({'diameter': [0.1, 0.0, 0.1]}, 'row 1: diameter .* is not positive'),
        ({'diameter': [[0.1, 0.1], [0.1, 0.1], [0.1, -0.1]]}, 'row 2: diameter'),
        ({'parent': [-1, 0, 3]}, 'row 2: orphan: its parent 3 does not exist; give a parent'),
        ({'parent': [-1, 0, -2]}, 'row 2: orphan'),
        ({'parent': [-1, 0, -1]}, 'row 2: 2 roots: .*only row 0'),
        ({'parent': [-1, 2, 1]}, 'row 1: cyclic: .*break the cycle'),
        ({'parent': [0, 0, 1]}, 'row 0: cyclic'),
        ({'parent': [-1.0, 0.0, 0.0]}, 'parent must be 3 integers'),
        ({'parent': [-1, 0]}, r'parent must be 3 integers, not \(2,\)'),
        ({'branch': ['a', 'a', 'b']}, 'branch must be 3 integers'),
        ({'branch': [0, [0], 1]}, 'branch must be 3 integers, not a list of lists'),
        ({'branch': [0, 0, 0]}, 'row 2: branch 0 is not one chain: .*its own branch'),
        ({'branch': [0, 1, 0], 'parent': [-1, 0, 1]}, 'row 2: branch 0 is not one chain'),
        ({'branch_names': ['only one']}, '1 branch names for 2 branches'),
    ],
)
def test_what_cannot_be_is_refused_with_place_and_cure(change, message):
    given_input = {
        'start': START,
        'end': END,
        'diameter': THICK,
        'labels': ['row 0', 'row 1', 'row 2'],
    }
    with pytest.raises(TreeError, match=message):
        tree_from_segments(**(given_input | change))


@pytest.mark.parametrize(
    ('start', 'end', 'diameter', 'message'),
    [
        ([[0, 0, 0], [0, 0]], [[0, 0, 1]] * 2, [0.1] * 2, 'start: not an array of numbers'),
        ([[0, 0, 0]], [['a', 0, 1]], [0.1], 'end: not an array of numbers'),
        ([[0, 0, 0]], [[0, 0, 1]], 0.1, 'diameter: 0 dimensions'),
        ([[0, 0, 0]], [[0, 0, 1]], None, 'diameter: 0 dimensions'),
        (1.0, 2.0, 0.1, 'start: 0 dimensions'),
    ],
)
def test_arrays_that_are_none_are_one_clear_error(start, end, diameter, message):
    with pytest.raises(TreeError, match=message):
        tree_from_segments(start, end, diameter)
