# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Roots that give way: a spring under the stem."""

from __future__ import annotations

from dataclasses import replace
import math

from drawn_trees import crown
import pytest
from scipy.optimize import brentq

from tree_sway.core.settings import Settings
from tree_sway.core.setup.reductions import TreeReductions
from tree_sway.core.species.species import species_named, typical_root_stiffness
from tree_sway.errors import ParameterError

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
    found = TreeReductions(pole, OAK, replace(USUAL, root_stiffness=spring))
    assert found.natural_frequencies(2) == pytest.approx(known, rel=0.01)


def test_roots_take_a_few_per_cent_of_the_frequency_of_a_tree():
    tree = crown()
    mass = float(OAK.density * tree.volume[tree.segments_of(0)].sum())
    rooted = replace(OAK, root_stiffness=typical_root_stiffness(mass))
    rigid, soft = (
        TreeReductions(tree, wood, USUAL).natural_frequencies(1)[0] for wood in (OAK, rooted)
    )
    # Roots of trees take a few per cent of the frequency (Neild & Wood 1999).
    assert 0.90 < soft / rigid < 0.99
    given_stiffness = TreeReductions(
        tree, rooted, replace(USUAL, root_stiffness=math.inf)
    ).natural_frequencies(1)[0]
    assert given_stiffness == pytest.approx(rigid)


@pytest.mark.parametrize('stiffness', [0.0, -1.0, math.nan])
def test_roots_that_cannot_be_are_refused(stiffness):
    with pytest.raises(ParameterError, match=r'root_stiffness: .* is out of range'):
        Settings(root_stiffness=stiffness)
