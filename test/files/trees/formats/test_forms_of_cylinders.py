# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Cylinders without parents or growth lengths, and points that are no tree."""

from __future__ import annotations

import pytest

from tree_sway.errors import FormatError
from tree_sway.files.trees.source import open_tree

ENDS = [((0, 0, k), (0, 0, k + 1), 0.1 - 0.01 * k) for k in range(6)]
ENDS += [((0, 0, 3), (1, 0, 3.5), 0.02), ((1, 0, 3.5), (2, 0, 4), 0.01)]


def flat(*cells: object) -> str:
    return ','.join(map(str, cells))


def test_ends_and_a_radius_are_joined_where_they_meet(tmp_path):
    path = tmp_path / 'ends.csv'
    lines = [flat(*begin, *end, radius) for begin, end, radius in ENDS]
    path.write_text('\n'.join(['x1,y1,z1,x2,y2,z2,radius', *lines]), encoding='utf-8')
    opened = open_tree(path)
    assert (opened.tree.n_segments, opened.tree.n_branches) == (8, 2)
    assert opened.tree.base_diameter[0] == pytest.approx(0.2)
    assert any('parents are found' in note for note in opened.notes)


def test_without_growth_lengths_the_thickest_child_continues(tmp_path):
    path = tmp_path / 'cylinders.csv'
    parents = [-1, 0, 1, 2, 3, 4, 2, 6]
    names = 'ID,parentID,startX,startY,startZ,endX,endY,endZ,radius,branchOrder'
    lines = [
        flat(number, parent, *begin, *end, radius, 0)
        for number, (parent, (begin, end, radius)) in enumerate(zip(parents, ENDS, strict=True))
    ]
    path.write_text('\n'.join([names, *lines]), encoding='utf-8')
    tree = open_tree(path).tree
    assert (tree.n_segments, tree.n_branches) == (8, 2)
    assert tree.segments_of(0).stop - tree.segments_of(0).start == 6


def test_points_are_no_tree(tmp_path):
    path = tmp_path / 'points.txt'
    path.write_text('0.1 0.2 3.4\n' * 20, encoding='utf-8')
    with pytest.raises(FormatError, match='a point cloud'):
        open_tree(path)
