# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Limp branches: weight that goes with them bends them further, as the textbooks have it."""

from __future__ import annotations

import numpy as np
import pytest

from tree_sway.core.setup.beams.beam import Attachments, BranchBeam, RotationField
from tree_sway.core.setup.beams.bent_by_weight import bent_by_weight
from tree_sway.core.setup.beams.subtree_sums import SubtreeSums

LENGTH, DIAMETER, SHEAR_RATIO = 2.0, 0.02, 1.0 / 14.0
SECOND_MOMENT = np.pi / 64.0 * DIAMETER**4


def further(direction, push, weight):
    """Return by how much a weight over the modulus, at its end, multiplies a rod's deflection."""
    n = 8
    nodes = np.linspace(0.0, LENGTH, n + 1)[:, None] * np.array(direction)
    foot = Attachments(np.array([n - 1]), np.array([1.0]))
    beam = BranchBeam(nodes[:-1], nodes[1:], np.full(n, DIAMETER), np.full(n, DIAMETER), foot)
    subtrees, tip = SubtreeSums.zeros(1), nodes[-1]
    subtrees.mass[:], subtrees.mass_moment[:] = 1.0, tip
    none = np.zeros(beam.weight.shape)
    force = np.array(push)[None, None]
    moment = beam.moment_in_space(np.zeros((*none.shape, 1, 3)), force, np.cross(tip, force))
    alone = beam.curvature_in_space(moment, SHEAR_RATIO)
    bent = bent_by_weight(beam, none, subtrees, alone, SHEAR_RATIO, weight)
    moved = [RotationField(beam, each[:, :, 0]).nodes[-1] @ push for each in (bent, alone)]
    return moved[0] / moved[1]


@pytest.mark.parametrize('u', [0.7, 1.0, 1.4])
def test_a_column_gives_way_as_a_beam_column(u):
    """Timoshenko & Gere 1961, eq. 1-24: u is the length times the root of P / EI."""
    weight = SECOND_MOMENT * (u / LENGTH) ** 2
    exact = 3.0 * (np.tan(u) - u) / u**3
    assert further((0.0, 0.0, 1.0), (1.0, 0.0, 0.0), weight) == pytest.approx(exact, rel=1e-9)


@pytest.mark.parametrize('u', [0.7, 2.0, 5.0])
def test_a_hanging_rod_is_stiffened_as_a_tie(u):
    weight = SECOND_MOMENT * (u / LENGTH) ** 2
    exact = 3.0 * (u - np.tanh(u)) / u**3
    assert further((0.0, 0.0, -1.0), (1.0, 0.0, 0.0), weight) == pytest.approx(exact, rel=1e-6)


def test_a_level_rod_gives_way_sideways_at_the_critical_load():
    """Timoshenko & Gere 1961, 6.3: 4.013 sqrt(EI GJ) / L^2; what is left of it goes to zero."""
    critical = 4.013 * SECOND_MOMENT * np.sqrt(2.0 * SHEAR_RATIO) / LENGTH**2
    square = np.array([0.9, 0.95]) ** 2
    left = [
        1.0 / further((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), np.sqrt(each) * critical)
        for each in square
    ]
    pole = square[1] + left[1] * (square[1] - square[0]) / (left[0] - left[1])
    assert np.sqrt(pole) == pytest.approx(1.0, abs=0.01)


def test_a_rod_that_its_weight_buckles_keeps_the_shape_of_the_load():
    weight = SECOND_MOMENT * (1.6 / LENGTH) ** 2
    assert further((0.0, 0.0, 1.0), (1.0, 0.0, 0.0), weight) == 1.0
