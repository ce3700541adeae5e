# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Grow what a scan could not see, and weigh the crown against others of its species and size.

1. **Pipes.** An end of a scan of diameter d is continued to the twigs of its species, of diameter
   t, by forks that keep the cross-section (pipe model: Shinozaki et al. 1964; Leonardo's rule).
   From a diameter to its tips there are 21 d^0.92 m (4,824 scanned branches), so the wood beyond
   has the volume pi/4 d^2 times the length to go, and an area, diameter times length of all pipes,
   of 19.32 d^2 (t^-0.08 - d^-0.08) / 0.08 m^2. Beyond the end of a scan that was cut at a diameter
   c all pipes are thinner than c, else they were scanned: there c replaces d in both brackets.
   Equal twigs of that volume and area, as long as the length to go, stand for it.
2. **Prior.** How much of a crown a scanner sees is partly chance; stem and height say as well how
   large it is (`crown_size`). The total area of its wood is drawn to that of the allometry in
   proportion to the variances of their logarithms: 0.30 for what was scanned, a factor of two for
   the share that was grown, and `AREA_SPREAD` for the allometry. The scan keeps its distribution:
   more or less is grown beyond its ends, and if the scan alone has more, wood thinner than is
   trusted is thinned. Only of broadleaves of at least 7 cm and 5 m: the allometry has no others.

A scan has been cut, and its thinnest wood is no twig seen too thick, where half of its ends are
thicker than 15 mm, three times the laser spot, without being of one thickness, as a lower bound of
the fit makes them. The lower quartile of its ends is then the diameter c.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
import math

import numpy as np

from tree_sway.core.arrays import Floats, Ints
from tree_sway.core.species import species_named
from tree_sway.core.tree import Tree, tree_from_segments
from tree_sway.growth.axis import GOLDEN_ANGLE
from tree_sway.growth.crown_allometry import AREA_SPREAD, breast_height_diameter, crown_size

_CUT_AT = 0.015
"""Median diameter of the ends from which on a scan has been cut in [m]."""

_SCAN_SPREAD, _GROWN_SPREAD = 0.30, math.log(2.0)
"""
Log-deviations of the area of what was scanned and of what was grown [-]: repeated scans of crowns
differ by 0.3 in the wood of their branches (Demol et al. 2022, Methods in Ecology and Evolution
13); the second is an estimate.
"""

_LENGTH = 21.0
_POWER = 0.92
_CLIPPED = 0.3
"""Share of the ends of one thickness from which a fit has a lower bound [-]."""
_MOST_TWIGS = 3000
_MOST_AT_AN_END = 40
_MOST_GROWN = 4.0
"""Largest number of times that the prior multiplies what is grown [-]."""
_THINNEST = 0.3
"""Smallest factor by which the prior thins wood [-]."""
_SMALLEST = 0.07, 5.0
"""Diameter and height in [m] from which on the allometry holds."""
_OPENING = math.radians(35.0)


@dataclass(frozen=True)
class Beyond:
    """
    What was grown beyond a scan.

    Parameters
    ----------
    end
        Median diameter of the ends that were continued in [m].
    grown
        Area of the grown wood over that of all wood but the stem [-].
    drawn
        Area of the crown's wood over that before it was drawn to the allometry [-].
    is_cut
        Whether the scan ends at a thickness.

    """

    end: float
    grown: float
    drawn: float
    is_cut: bool

    def sentence(self) -> str:
        """Say what was grown, in one sentence."""
        drawn = ''
        if abs(self.drawn - 1.0) > 0.005:
            drawn = f', its area drawn to {self.drawn:.2f} times by the allometry of its species'
        return (
            f'the scan ends at {1e3 * self.end:.3g} mm; {100.0 * self.grown:.0f} % of the area of '
            f'its crown is grown beyond it{drawn} (beyond_scan=none leaves it)'
        )


def is_cut(tree: Tree) -> bool:
    """Whether a scan ends at a thickness; else its thinnest wood are its twigs."""
    last = tree.branch_first[1:] - 1
    ends = tree.tip_diameter[last]
    thinnest = float(np.percentile(ends, 2.0))
    widest = np.maximum(tree.base_diameter[last], ends)
    if (np.abs(widest - thinnest) < 1e-3 * thinnest).mean() > _CLIPPED:
        return False
    return float(np.median(ends)) >= _CUT_AT


def grown_beyond(tree: Tree, twig: float, trusted: float) -> tuple[Tree, Beyond | None]:
    """
    Grow the wood beyond the ends of a scan.

    Parameters
    ----------
    tree
        Tree as scanned, its twigs corrected.
    twig
        Diameter of the last twigs in [m].
    trusted
        Diameter above which the scan is trusted in [m].

    Returns
    -------
    tuple
        The tree with its twigs, and what was grown; the tree itself and None if it has no ends
        thicker than two twigs.

    """
    last = tree.branch_first[1:] - 1
    diameter = open_diameter(tree)
    open_ends = np.flatnonzero(diameter > 2.0 * twig)
    if len(open_ends) == 0 or twig <= 0.0:
        return tree, None
    cut = is_cut(tree)
    ends = last[open_ends]
    d = diameter[open_ends]
    pipe = np.minimum(d, float(np.percentile(d, 25.0))) if cut else d
    length, volume, area = _beyond(d, pipe, twig)
    seen = _crown_area(tree)
    factor, thinner = _prior(tree, seen, float(area.sum()), trusted)
    grown = _with_twigs(thinner, ends, d, length, factor * volume, factor * area)
    now = _crown_area(grown)
    share = 1.0 - _crown_area(thinner) / now
    drawn = now / (seen + float(area.sum()))
    return grown, Beyond(float(np.median(d)), share, drawn, cut)


def open_diameter(tree: Tree) -> Floats:
    """Return the diameter of the ends of branches [m], less the section of those that follow."""
    section = tree.tip_diameter**2
    first = tree.branch_first[1:-1]
    above = tree.segment_parent[first]
    gap = np.linalg.norm(tree.start[first] - tree.end[above], axis=1)
    continues = gap <= 0.1 * tree.length[above]
    np.subtract.at(section, above[continues], tree.base_diameter[first[continues]] ** 2)
    return np.sqrt(np.maximum(section[tree.branch_first[1:] - 1], 0.0))


def _crown_area(tree: Tree) -> float:
    """Diameter times length of all wood but the stem in [m^2]."""
    wide = 0.5 * (tree.base_diameter + tree.tip_diameter) * tree.length
    return float(wide[tree.branch_first[1] :].sum())


def _beyond(d: Floats, pipe: Floats, twig: float) -> tuple[Floats, Floats, Floats]:
    """Length to go [m], volume [m^3] and area [m^2] beyond ends d [m], of pipes [m]."""
    length = _LENGTH * (pipe**_POWER - twig**_POWER)
    rest = 1.0 - _POWER
    area = _LENGTH * _POWER * d**2 * (twig**-rest - pipe**-rest) / rest
    return length, 0.25 * math.pi * d**2 * length, area


def _prior(tree: Tree, seen: float, beyond: float, trusted: float) -> tuple[float, Tree]:
    """Find the factor of what is grown, and the tree, its thin wood thinned if it has too much."""
    diameter = breast_height_diameter(tree)
    height = tree.height
    crown = None if diameter is None else crown_size(tree.species, diameter, height)
    is_broadleaf = species_named(tree.species).habit == 'broadleaf'
    if crown is None or diameter is None or not is_broadleaf:
        return 1.0, tree
    if diameter < _SMALLEST[0] or height < _SMALLEST[1]:
        return 1.0, tree
    total = seen + beyond
    variance = _SCAN_SPREAD**2 + (_GROWN_SPREAD * beyond / total) ** 2
    weight = variance / (variance + AREA_SPREAD**2)
    wanted = total ** (1.0 - weight) * crown.wood_area**weight
    if wanted >= seen:
        return min((wanted - seen) / beyond, _MOST_GROWN), tree
    low = _THINNEST
    high = 1.0
    for _ in range(40):
        middle = 0.5 * (low + high)
        is_less = _crown_area(_thinned(tree, middle, trusted)) < wanted
        low, high = (middle, high) if is_less else (low, middle)
    return 0.0, _thinned(tree, high, trusted)


def _thinned(tree: Tree, factor: float, trusted: float) -> Tree:
    """Return the tree with thin wood thinner by a factor; trusted wood and the stem stay."""
    is_branch = np.arange(tree.n_segments) >= tree.branch_first[1]

    def thinned(diameter: Floats) -> Floats:
        share = factor + (1.0 - factor) * np.minimum(diameter / trusted, 1.0)
        return np.where(is_branch, share * diameter, diameter)

    return replace(
        tree,
        base_diameter=thinned(tree.base_diameter),
        tip_diameter=thinned(tree.tip_diameter),
    )


def _with_twigs(
    tree: Tree, ends: Ints, d: Floats, length: Floats, volume: Floats, area: Floats
) -> Tree:
    """Return the tree with equal twigs of a volume and an area at the end of some segments."""
    has = area > 1e-9
    ends = ends[has]
    length = length[has]
    volume = volume[has]
    area = area[has]
    if len(ends) == 0:
        return tree
    thick = 4.0 / math.pi * volume / area
    count = np.clip(np.rint(area / (thick * length)), 1, _MOST_AT_AN_END)
    if count.sum() > _MOST_TWIGS:
        count = np.maximum(np.floor(count * _MOST_TWIGS / count.sum()), 1)
    # Fewer twigs are longer, up to twice; what is then left is in their thickness.
    reach = np.minimum(area / (thick * count), 2.0 * length)
    thick = area / (reach * count)
    count = count.astype(np.int64)
    at = np.repeat(np.arange(len(ends)), count)
    number = np.arange(len(at)) - np.repeat(np.cumsum(count) - count, count)
    along = tree.direction[ends][at]
    opening = np.where(count[at] == 1, 0.0, _OPENING).astype(np.float64)
    way = _around(along, opening, GOLDEN_ANGLE * np.arange(len(at), dtype=np.float64))
    start = tree.end[ends][at]
    width = thick[at]
    branch = tree.branch_of_segment
    owner = branch[ends][at]
    names = [
        f'{tree.branch_names[b]}_{n + 1}'
        for b, n in zip(owner.tolist(), number.tolist(), strict=True)
    ]
    both = np.stack([tree.base_diameter, tree.tip_diameter], axis=1)
    return tree_from_segments(
        np.vstack([tree.start, start]),
        np.vstack([tree.end, start + reach[at][:, None] * way]),
        np.vstack([both, np.stack([width, width], axis=1)]),
        parent=np.concatenate([tree.segment_parent, ends[at]]),
        branch=np.concatenate([branch, tree.n_branches + np.arange(len(at))]),
        branch_names=[*tree.branch_names, *names],
        name=tree.name,
        species=tree.species,
    )


def _around(along: Floats, opening: Floats, turn: Floats) -> Floats:
    """Return unit vectors at an angle from others, (m, 3), turned about them by a further one."""
    reference = np.where(np.abs(along[:, 2:]) > 0.9, [1.0, 0.0, 0.0], [0.0, 0.0, 1.0])
    first = np.cross(along, reference)
    first /= np.linalg.norm(first, axis=1)[:, None]
    second = np.cross(along, first)
    side = np.cos(turn)[:, None] * first + np.sin(turn)[:, None] * second
    return np.asarray(np.cos(opening)[:, None] * along + np.sin(opening)[:, None] * side)
