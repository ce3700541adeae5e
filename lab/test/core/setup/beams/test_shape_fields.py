# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Frequencies of trees whose limbs swing apart, against segments that are solved."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from tree_sway_lab.segments.articulated import ArticulatedTree

from tree_sway.core.settings import Settings
from tree_sway.core.setup.reductions import TreeReductions
from tree_sway.core.species.species import Species
from tree_sway.core.tree.building import tree_from_segments


def stem_with_limbs(n_limbs):
    """Make a straight stem of 8 m whose limbs carry nothing."""
    start, end, thick, parent, branch = [], [], [], [], []

    def add(on, root, way, length, base, tip, cuts, number):
        nodes = root + np.linspace(0.0, length, cuts + 1)[:, None] * way
        first, width = len(start), np.linspace(base, tip, cuts + 1)
        start.extend(nodes[:-1]), end.extend(nodes[1:]), thick.extend(pairwise(width))
        parent.extend([on, *range(first, first + cuts - 1)])
        branch.extend([number] * cuts)

    add(-1, np.zeros(3), np.array([0.0, 0.0, 1.0]), 8.0, 0.14, 0.04, 16, 0)
    for k in range(n_limbs):
        node, turn = 4 + (k * 12) // n_limbs, 2.4 * k
        way = np.array([0.92 * np.cos(turn), 0.92 * np.sin(turn), 0.39])
        way /= np.linalg.norm(way)
        length = 2.2 * (1.1 - node / 20.0)
        root = np.array([0.0, 0.0, 0.5 * node])
        add(node - 1, root, way, length, length / 45.0, length / 110.0, 5, k + 1)
    return tree_from_segments(start, end, thick, parent=np.array(parent), branch=np.array(branch))


@pytest.mark.parametrize('n_limbs', [2, 4, 8, 16])
def test_limbs_that_swing_apart_have_the_frequencies_of_every_segment(n_limbs):
    tree = stem_with_limbs(n_limbs)
    truth = ArticulatedTree(
        tree, 8e9, 900.0, gravity=9.81, subdivisions=2, twist_ratio=2.0 / 14.0
    ).linear_modes(8)[0]
    wood = Species('w', 'w', 8e9, 900.0, damping_bare=0.05, shear_ratio=1.0 / 14.0)
    found = TreeReductions(tree, wood, Settings()).natural_frequencies(8)
    assert found == pytest.approx(truth, rel=0.01)
