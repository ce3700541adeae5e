# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Twigs that copy: which ones, and of whom."""

from __future__ import annotations

import pytest
from tree_sway_lab.paper.similar_twigs import twig_sources


def brush(sketch, twigs):
    """Make a stem with twigs on its node 2: each of direction, length and diameter."""
    drawn = sketch()
    drawn.add(None, 0, (0, 0, 1), 1.0, 0.02, 0.01, 4)
    for direction, length, thick in twigs:
        drawn.add(0, 2, direction, length, thick, thick / 2, 1)
    return drawn.tree()


ALIKE = ((1.0, 0.0, 1.0), 0.2, 0.004)


def test_of_many_alike_one_is_solved(sketch):
    tree = brush(sketch, [ALIKE] * 4)
    assert twig_sources(tree, 0.0).tolist() == [0, 1, 1, 1, 1]


@pytest.mark.parametrize(
    'other',
    [((1.0, 0.3, 1.0), 0.2, 0.004), ((1.0, 0.0, 1.0), 0.25, 0.004), ((1.0, 0.0, 1.0), 0.2, 0.005)],
    ids=['direction', 'length', 'diameter'],
)
def test_a_difference_beyond_the_tolerance_is_solved(sketch, other):
    tree = brush(sketch, [ALIKE, other])
    assert twig_sources(tree, 0.05).tolist() == [0, 1, 2]
    assert twig_sources(tree, 0.5).tolist() == [0, 1, 1]


def test_a_negative_tolerance_solves_all(sketch):
    assert twig_sources(brush(sketch, [ALIKE] * 3), -1.0).tolist() == [0, 1, 2, 3]


def test_only_twigs_of_one_parent_and_one_segment_that_carry_nothing_copy(sketch):
    drawn = sketch()
    drawn.add(None, 0, (0, 0, 1), 1.0, 0.02, 0.01, 4)
    one, other = (drawn.add(0, 2, (side, 0, 1), 0.4, 0.008, 0.004, 2) for side in (1, 1))
    for limb in (one, other):
        drawn.add(limb, 2, (1, 0, 1), 0.1, 0.003, 0.002, 1)
    drawn.add(0, 4, (0, 1, 1), 0.3, 0.006, 0.004, 1)
    carrier = drawn.add(0, 4, (0, 1, 1), 0.3, 0.006, 0.004, 1)
    drawn.add(carrier, 1, (0, 1, 1), 0.1, 0.002, 0.001, 1)
    tree = drawn.tree()
    assert twig_sources(tree, 0.1).tolist() == list(range(tree.n_branches))
