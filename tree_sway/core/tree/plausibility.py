# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Numbers that no tree has: what is impossible is refused, what is only odd is reported.

Both are nearly always a unit, so both name the likely one and the option that mends it. Trees are
at most 116 m high (Sequoia sempervirens) and 14 m thick (Taxodium mucronatum), green wood of
living stems has 3 to 20 GPa and 400 to 1300 kg/m^3, and stems are 10 to 150 times as high as
thick. What lies ten times and more beyond that is refused. The slowest sway of a tree of its size
is that of 602 measured conifers, ``f = 0.0766 + 3.1219 D / H^2`` in [Hz], D in [cm], H in [m]
(Moore & Maguire 2004).
"""

from __future__ import annotations

from collections.abc import Iterator
import math

import numpy as np

from tree_sway.core.tree.species import Species
from tree_sway.core.tree.tree import Tree
from tree_sway.errors import ParameterError, TreeError

_MODULUS, _DENSITY = (3e9, 20e9), (400.0, 1300.0)
_MODULUS_LIMIT, _DENSITY_LIMIT = (1e7, 5e11), (40.0, 10_000.0)
_HEIGHT, _HEIGHT_LIMIT = (0.05, 116.0), 250.0
_DIAMETER, _DIAMETER_LIMIT = 5.0, 20.0
_SLENDERNESS, _SLENDERNESS_LIMIT = (8.0, 200.0), (2.0, 2000.0)
_USUAL_HEIGHT, _USUAL_SLENDERNESS = 12.0, 50.0
_LEAN = 60.0
_SWAY_FACTOR = 5.0
_LENGTHS = {0.001: 'mm', 0.01: 'cm'}


def refuse_nonsense(tree: Tree, species: Species) -> None:
    """
    Refuse a tree whose numbers are in another unit than SI.

    Raises a `ParameterError` for modulus or density of the wood, a `TreeError` for height or
    diameter.
    """
    _refuse_wood('modulus', species.modulus, 'Pa', _MODULUS_LIMIT, {1e9: 'GPa', 1e6: 'MPa'})
    _refuse_wood('density', species.density, 'kg/m^3', _DENSITY_LIMIT, {1e3: 'g/cm^3'})
    height, diameter, slenderness = _size(tree)
    size = f'a height of {height:.4g} m and a diameter of {diameter:.4g} m at the ground'
    low, high = _SLENDERNESS_LIMIT
    if slenderness > high:
        factor = _nearest(slenderness, _USUAL_SLENDERNESS)
        unit = f'positions are in {_LENGTHS[factor]}: add --option length_unit={factor:g}'
    elif slenderness < low and diameter > 1.0:
        factor = _nearest(1.0 / slenderness, 1.0 / _USUAL_SLENDERNESS)
        unit = f'diameters are in {_LENGTHS[factor]}: add --option diameter_unit={factor:g}'
    elif height > _HEIGHT_LIMIT or diameter > _DIAMETER_LIMIT:
        factor = _nearest(height, _USUAL_HEIGHT)
        unit = f'lengths are in {_LENGTHS[factor]}: add --option length_unit={factor:g}'
        unit += f' --option diameter_unit={factor:g}'
    else:
        return
    raise TreeError(size, where=tree.name, cure=f'give metres; if {unit}')


def oddities(tree: Tree, species: Species) -> tuple[str, ...]:
    """Report what is odd about a tree and its wood against others, one sentence each."""
    return tuple(_doubts(tree, species))


def sway_oddity(tree: Tree, species: Species, frequency: float) -> str:
    """Say whether a conifer sways, in [Hz], far off others of its size; empty if it does not."""
    if species.habit != 'conifer':
        return ''
    height, diameter, _ = _size(tree)
    usual = 0.0766 + 3.1219 * 100.0 * diameter / height**2
    if usual / _SWAY_FACTOR <= frequency <= usual * _SWAY_FACTOR:
        return ''
    return (
        f'its slowest sway has {frequency:.3g} Hz, where conifers of its size have some '
        f'{usual:.2g} Hz: check --modulus, --density and the diameters (--option twig_diameter)'
    )


def _doubts(tree: Tree, species: Species) -> Iterator[str]:
    wood = (
        ('modulus', species.modulus / 1e9, 'GPa', [each / 1e9 for each in _MODULUS]),
        ('density', species.density, 'kg/m^3', list(_DENSITY)),
    )
    for name, value, unit, (low, high) in wood:
        if not low <= value <= high:
            yield (
                f'a {name} of {value:.3g} {unit}, where green wood has {low:g} to {high:g} {unit}'
                f': check --{name}'
            )
    height, diameter, slenderness = _size(tree)
    low, high = _HEIGHT
    if not low <= height <= high:
        yield (
            f'a height of {height:.3g} m, where trees have {low:g} to {high:g} m: if the file is '
            'not in metres, add --option length_unit=0.01 for cm, or what it is'
        )
    if diameter > _DIAMETER:
        yield (
            f'a diameter of {diameter:.3g} m at the ground: if diameters are in cm, add '
            '--option diameter_unit=0.01'
        )
    low, high = _SLENDERNESS
    if not low <= slenderness <= high:
        much = 'thick' if slenderness < low else 'thin'
        yield (
            f'{slenderness:.3g} times as high as thick at the ground, where stems have {low:g} to '
            f'{high:g}: its diameters may be too {much}; --option diameter_unit says their unit'
        )
    lean = _lean(tree)
    if lean > _LEAN:
        yield (
            f'it leans {lean:.0f} degrees from the vertical: if the y axis of its file points up, '
            'add --option up=y'
        )


def _refuse_wood(
    name: str, value: float, unit: str, limits: tuple[float, float], others: dict[float, str]
) -> None:
    low, high = limits
    if low <= value <= high:
        return
    likely = [(each, factor) for factor, each in others.items() if low <= value * factor <= high]
    usual = {'modulus': _MODULUS, 'density': _DENSITY}[name]
    likely.sort(key=lambda each: not usual[0] <= value * each[1] <= usual[1])
    cure = f'give {low:g} to {high:g} {unit}'
    if likely:
        other, factor = likely[0]
        cure = f'give {unit}: {value:g} {other} are --{name} {value * factor:g}'
    raise ParameterError(f'{value:g} {unit}, which no wood has', where=name, cure=cure)


def _size(tree: Tree) -> tuple[float, float, float]:
    """Height, or length if it lies, diameter at the ground, both [m], and their ratio."""
    nodes = np.vstack([tree.start, tree.end]) - tree.start[0]
    height = max(tree.height, float(np.abs(nodes).max()) if _lean(tree) > _LEAN else 0.0)
    diameter = float(tree.base_diameter[0])
    return height, diameter, height / diameter


def _lean(tree: Tree) -> float:
    """Angle between the vertical and the line from the base to the middle of the wood in [deg]."""
    middle = 0.5 * (tree.start + tree.end) - tree.start[0]
    x, y, z = (tree.length @ middle).tolist()
    return math.degrees(math.atan2(math.hypot(x, y), z))


def _nearest(value: float, usual: float) -> float:
    """Return the unit in [m] that brings a value nearest to the usual one."""
    return min(_LENGTHS, key=lambda factor: abs(math.log(value * factor / usual)))
