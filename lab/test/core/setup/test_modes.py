# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Natural modes against a frame of beams and against segments that are solved."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from tree_sway_lab.segments.articulated import ArticulatedTree

from tree_sway.core.settings import Settings
from tree_sway.core.setup.reductions import TreeReductions
from tree_sway.core.species.species import Species
from tree_sway.core.tree.building import tree_from_segments

TREE_121 = Path(__file__).parents[4] / 'test' / 'files' / 'data' / 'tree121.csv'


def test_a_tree_of_121_branches_has_the_modes_of_its_beam_frame():
    """
    0.7154 0.7254 1.4084 1.7586 Hz, from an Euler-Bernoulli frame of 17,424 degrees of freedom.

    E is 8 GPa, the density 900 kg/m^3, and the twist that of an isotropic rod.
    """
    rows = np.genfromtxt(TREE_121, delimiter=',', names=True)
    columns = [np.stack([rows[c + k] for c in 'xyz'], axis=1) for k in '01']
    tree = tree_from_segments(
        *columns,
        np.stack([rows['d0'], rows['d1']], axis=1),
        parent=rows['parent'].astype(int),
        branch=rows['branch'].astype(int),
    )
    wood = Species('frame', 'frame', modulus=8e9, density=900.0, shear_ratio=1 / 2.6)
    found = TreeReductions(tree, wood, Settings(gravity=0.0)).natural_frequencies(4)
    assert found == pytest.approx([0.7154, 0.7254, 1.4084, 1.7586], rel=0.005)
    # Green wood twists more easily, and the weight of what leans helps it to.
    green = replace(wood, shear_ratio=1 / 14)
    for gravity in (0.0, 9.81):
        reductions = TreeReductions(tree, green, Settings(gravity=gravity))
        chain = ArticulatedTree(
            tree, 8e9, 900.0, gravity=gravity, subdivisions=2, twist_ratio=2 / 14
        )
        found = reductions.natural_frequencies(12)
        assert found == pytest.approx(chain.linear_modes(12)[0], rel=0.005)
