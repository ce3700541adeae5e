# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Plausible values of trees: impossible ones are refused, unusual ones are reported.

The cause is nearly always a unit, so messages name the likely one and the option for it. Trees are
at most 116 m high (Sequoia sempervirens) and 14 m thick (Taxodium mucronatum), green wood of
living stems has 3 to 20 GPa and 400 to 1300 kg/m^3, and stems have 10 to 150 times the height of
their diameter. Values beyond ten times that are refused.
"""

from __future__ import annotations

import math

import numpy as np

from tree_sway.core.species import Species
from tree_sway.core.tree.tree import Tree
from tree_sway.errors import ParameterError, TreeError

_WOOD = {'modulus': ('Pa', 1e7, 5e11), 'density': ('kg/m^3', 40.0, 10_000.0)}
"""Unit and limits of the values of wood."""
_HEIGHT_LIMIT = 250.0
_SMALLEST = 0.03
"""Height that no tree falls below [m]: a seedling of a few days."""
_IN_MM = 3000.0
"""Height above which numbers are millimetres rather than centimetres."""
_DIAMETER_LIMIT = 20.0
_SLENDERNESS_LIMIT = (2.0, 2000.0)
_LEAN = 60.0
_FARTHEST = 1e4
"""Distance [m] at which single precision has steps of a millimetre."""


def refuse_implausible(tree: Tree, species: Species) -> None:
    """
    Refuse a tree whose numbers are not in SI units.

    Raises a `ParameterError` for modulus or density of the wood, a `TreeError` for height or
    diameter.
    """
    for name, (unit, low, high) in _WOOD.items():
        value = getattr(species, name)
        if not low <= value <= high:
            what = f'{value:g} {unit}, which no wood has'
            raise ParameterError(what, where=name, cure=f'give {low:g} to {high:g} {unit}')
    height, diameter, slenderness = _size(tree)
    low, high = _SLENDERNESS_LIMIT
    is_stout = slenderness < low and diameter > 1.0
    if slenderness > high or is_stout or height > _HEIGHT_LIMIT or diameter > _DIAMETER_LIMIT:
        raise TreeError(
            f'a height of {height:.4g} m and a diameter of {diameter:.4g} m at the ground',
            where=tree.name,
            cure='give metres, or the units of its file: --option length_unit=0.01 if positions '
            'are in cm, --option diameter_unit=0.01 if diameters are in cm, 0.001 if in mm',
        )


def refuse_no_metres(tree: Tree) -> None:
    """Raise a `TreeError` for a tree whose size is not in metres, with the likely factor."""
    height = _size(tree)[0]
    if not _SMALLEST <= height <= _HEIGHT_LIMIT:
        large = 0.001 if height > _IN_MM else 0.01
        factor = 1000.0 if height < _SMALLEST else large
        raise TreeError(
            f'a height of {height:.4g} m, which no tree has',
            where=tree.name,
            cure=f'give metres: multiply positions and diameters by {factor:g}',
        )


def oddities(tree: Tree, species: Species) -> tuple[str, ...]:
    """Report unusual values of a tree and its wood, one sentence each."""
    height, diameter, slenderness = _size(tree)
    rows = (
        ('modulus', species.modulus / 1e9, ' GPa', 'green wood has', (3.0, 20.0),
         'check --modulus'),
        ('density', species.density, ' kg/m^3', 'green wood has', (400.0, 1300.0),
         'check --density'),
        ('height', height, ' m', 'trees have', (0.05, 116.0),
         'if the file is not in metres, add --option length_unit=0.01 for cm, or its unit'),
        ('diameter at the ground', diameter, ' m', 'trees have', (0.0, 5.0),
         'if diameters are in cm, add --option diameter_unit=0.01'),
        ('height over diameter', slenderness, '', 'stems have', (8.0, 200.0),
         'its diameters may be too thick or too thin; --option diameter_unit sets their unit'),
        ('distance from the origin', float(np.linalg.norm(tree.start[0])), ' m', 'pictures have',
         (0.0, _FARTHEST), 'as they round places there, add --option to_origin=yes'),
        ('lean', _lean(tree), ' degrees', 'trees have', (0.0, _LEAN),
         'if the y axis of its file points up, add --option up=y'),
    )  # fmt: skip
    return tuple(
        f'a {what} of {value:.3g}{unit}, where {whose} {low:g} to {high:g}{unit}: {cure}'
        for what, value, unit, whose, (low, high), cure in rows
        if not low <= value <= high
    )


def _size(tree: Tree) -> tuple[float, float, float]:
    """Height, or length if horizontal, diameter at the ground, both [m], and their ratio."""
    nodes = np.vstack([tree.start, tree.end]) - tree.start[0]
    height = max(tree.height, float(np.abs(nodes).max()) if _lean(tree) > _LEAN else 0.0)
    diameter = float(tree.base_diameter[0])
    return height, diameter, height / diameter


def _lean(tree: Tree) -> float:
    """Angle between the vertical and the line from the base to the middle of the wood in [deg]."""
    middle = 0.5 * (tree.start + tree.end) - tree.start[0]
    x, y, z = (tree.length @ middle).tolist()
    return math.degrees(math.atan2(math.hypot(x, y), z))
