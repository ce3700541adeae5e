# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Roots that give way, in both references as in the models and the closed form."""

from __future__ import annotations

from dataclasses import replace
import math

import numpy as np
import pytest
from scipy.optimize import brentq
from tree_sway_lab.frame.frame import frame_model
from tree_sway_lab.segments.articulated import ArticulatedTree

from tree_sway.core.settings import Settings
from tree_sway.core.setup.reductions import TreeReductions
from tree_sway.core.species.species import species_named, typical_root_stiffness
from tree_sway.growth.growing import grow

OAK = species_named('oak')
LENGTH, WIDTH = 5.0, 0.1
BENDING = OAK.modulus * math.pi / 64.0 * WIDTH**4
USUAL = Settings(model=2, gravity=0.0, in_leaf=False)


def first_frequency(ratio: float) -> float:
    """
    Of a uniform beam on a spring of ``ratio EI / L``, its other end free (Blevins 1979, ch. 8).

    It is ``ratio (1 + cos x cosh x) = x (sin x cosh x - cos x sinh x)``.
    """

    def zero(x: float) -> float:
        free = math.sin(x) * math.cosh(x) - math.cos(x) * math.sinh(x)
        return ratio * (1.0 + math.cos(x) * math.cosh(x)) - x * free

    root = float(brentq(zero, 1e-3, 1.8751))
    line_mass = OAK.density * math.pi / 4.0 * WIDTH**2
    return root**2 / (2.0 * math.pi * LENGTH**2) * math.sqrt(BENDING / line_mass)


@pytest.mark.parametrize('ratio', [1.0, 5.0, 40.0])
def test_a_pole_on_a_spring_sways_as_the_closed_form(ratio, stem):
    pole, spring = stem(length=LENGTH, base=WIDTH, cuts=16), ratio * BENDING / LENGTH
    known = first_frequency(ratio)
    frame = frame_model(pole, OAK.modulus, OAK.density, root_stiffness=spring)
    assert frame.frequencies(1)[0] == pytest.approx(known, rel=1e-3)
    pieces = ArticulatedTree(pole, OAK.modulus, OAK.density, subdivisions=4, root_stiffness=spring)
    assert pieces.linear_modes(1)[0][0] == pytest.approx(known, rel=0.01)


def test_a_tree_of_its_own_roots_is_the_same_in_every_model():
    tree = grow('walnut', 6.0, rng=np.random.default_rng(0))
    mass = float(OAK.density * tree.volume[tree.segments_of(0)].sum())
    rooted = replace(OAK, root_stiffness=typical_root_stiffness(mass))
    rigid, soft = (
        TreeReductions(tree, wood, USUAL).natural_frequencies(1)[0] for wood in (OAK, rooted)
    )
    frame = [
        frame_model(
            tree, OAK.modulus, OAK.density, subdivisions=1,
            shear_ratio=OAK.shear_ratio, root_stiffness=wood.root_stiffness,
        ).frequencies(1)[0]
        for wood in (OAK, rooted)
    ]  # fmt: skip
    assert soft / rigid == pytest.approx(frame[1] / frame[0], rel=0.005)
