# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Grow a plausible tree of any size, for users without a scan.

Without a measured diameter a broadleaf is 45 of its diameters high, as first-order axes of scanned
trees (allometry of 4,824 branches). The diameter of a conifer is proportional to the height to the
power 1.5, so that trees of all sizes keep the same reserve against bending over (elastic
similarity: McMahon 1973); at 20 m it is 60 diameters high, below the 70 that foresters consider
stable (Wang, Titus & LeMay 1998), and never more than 90. A measured diameter thins or widens the
crown with the stem (`crown_change`).
"""

from __future__ import annotations

from dataclasses import replace
import math

import numpy as np

from tree_sway.core.checks import number_of
from tree_sway.core.random_source import generator_of
from tree_sway.core.setup import greenhill_length
from tree_sway.core.species import Species, species_named
from tree_sway.core.tree import Tree
from tree_sway.errors import ParameterError
from tree_sway.growth.benjamina import grow_benjamina
from tree_sway.growth.broadleaf import grow_broadleaf
from tree_sway.growth.conifer import grow_conifer
from tree_sway.growth.crown_allometry import crown_change
from tree_sway.growth.forms import broadleaf_form, changed_form, conifer_form
from tree_sway.growth.goldcrest import grow_goldcrest

_POT_SLENDERNESS = 58.0
_HEIGHTS = {'conifer': (1.0, 60.0), 'broadleaf': (1.0, 50.0), 'pot': (0.2, 4.0)}
_GRAVITY = 9.81


def grow(
    species: str,
    height: float,
    diameter: float | None = None,
    *,
    rng: np.random.Generator | int = 0,
    name: str | None = None,
) -> Tree:
    """
    Grow a tree of a species from its height and the thickness of its stem.

    Parameters
    ----------
    species
        Key of the species table, or another name of the species.
    height
        Height in [m].
    diameter
        Diameter in [m] at breast height, 1.3 m; at the base of a pot plant and of a tree below
        2.6 m. From the height if None.
    rng
        Source of randomness, or its seed; the same state gives the same tree.
    name
        Name of the tree; the key of the species if None.

    Returns
    -------
    Tree
        Tree of exactly that height and diameter.

    Raises
    ------
    SpeciesError
        If the species is unknown.
    ParameterError
        If height or diameter is out of range, the stem would buckle, or a type is wrong.

    """
    wood = species_named(species)
    species = wood.key
    kind = wood.habit
    refuse_height(wood, height)
    random = generator_of(rng)
    usual = height / _slenderness(kind, species, height)
    if diameter is None:
        diameter = usual
    thinnest, thickest = stem_range(wood, height)
    if not thinnest <= number_of('diameter', diameter) <= thickest:
        why = 'would bend over under its own weight' if diameter < thinnest else 'is no stem'
        what = f'diameter {diameter:.4g} m at a height of {height:g} m {why}'
        cure = f'give {thinnest:.3g} to {thickest:.3g} m'
        raise ParameterError(what, where='diameter', cure=cure)
    change = crown_change(species, height, usual, diameter)
    if kind == 'conifer':
        conifer = changed_form(conifer_form(species), change)
        tree = grow_conifer(random, height, diameter, species, conifer)
    elif kind == 'broadleaf':
        broadleaf = changed_form(broadleaf_form(species), change)
        tree = grow_broadleaf(random, height, diameter, species, broadleaf)
    else:
        generator = grow_goldcrest if species == 'goldcrest' else grow_benjamina
        tree = generator(random, height, diameter, species)
    return replace(tree, name=name or species)


def refuse_height(wood: Species, height: float) -> None:
    """Raise a `ParameterError` for a height [m] that `grow` does not give a species."""
    low, high = _HEIGHTS[wood.habit]
    height = number_of('height', height)
    if not low <= height <= high:
        what = f"height {height:g} m is out of range for the habit '{wood.habit}'"
        raise ParameterError(what, where='height', cure=f'give {low:g} to {high:g} m')


def _slenderness(kind: str, species: str, height: float) -> float:
    if kind == 'conifer':
        return min(60.0 * (20.0 / height) ** 0.5, 90.0)
    return broadleaf_form(species).slenderness if kind == 'broadleaf' else _POT_SLENDERNESS


def height_of_stem(species: str, diameter: float) -> float:
    """Height [m] at which `grow` gives a species a diameter [m], within the range of its habit."""
    wood = species_named(species)
    heights = np.linspace(*_HEIGHTS[wood.habit], 200)
    stems = [height / _slenderness(wood.habit, wood.key, height) for height in heights]
    return float(np.interp(diameter, stems, heights))


def stem_range(wood: Species, height: float) -> tuple[float, float]:
    """
    Smallest and largest diameter [m] that `grow` accepts for a height [m].

    With the smallest a bare stem has 0.8 of Greenhill's length, a reserve for the crown.
    """
    # EI and the weight per length of a rod of 1 m; the length is proportional to the diameter to
    # the power 2/3.
    area = math.pi / 4.0
    of_one = greenhill_length(wood.modulus * area / 16.0, wood.density * _GRAVITY * area)
    return float((height / 0.8 / of_one) ** 1.5), height / 5.0
