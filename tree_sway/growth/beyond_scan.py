# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Grow what a scan could not see, and weigh what it saw against trees of its size.

1. **Pipes.** An end of a scan of diameter d is continued to the twigs of its species, of diameter
   t, by forks that keep the cross-section (pipe model: Shinozaki et al. 1964; Leonardo's rule).
   From a diameter to its tips there are 21 d^0.92 m (4,824 scanned branches), so the wood beyond
   has the volume pi/4 d^2 times the length to go, and an area, diameter times length of all pipes,
   of 19.32 d^2 (t^-0.08 - d^-0.08) / 0.08 m^2. Beyond the end of a scan that was cut at a diameter
   c all pipes are thinner than c, else they were scanned: there c replaces d in both brackets.
   Equal twigs of that volume and area, as long as the length to go, stand for it.
2. **Allometry.** How much of a crown a scanner sees is partly chance, and it sees thin wood too
   thick; stem and height say better how much wood and area a tree has (`wood_volume`,
   `crown_size`). Their logarithms are the mean of both with the weight `SCAN_WEIGHT` of the scan.
   The excess of wood is a length by which a beam widens every branch, as in felled trees (Demol et
   al. 2022, Silva Fennica 56, 10550): all branches of a scan that was cut are thinner by one
   length, and twigs beyond it are thinner or thicker at the same wood until the area is right.
   Only of broadleaves of at least 7 cm and 5 m: the allometry has no others.

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
from tree_sway.core.tree import (
    breast_height_diameter,
    crown_size,
    Tree,
    tree_from_segments,
    wood_volume,
)

CUT_AT = 0.015
"""Median diameter of the ends from which on a scan has been cut in [m]."""

SCAN_WEIGHT = 0.2
"""
Weight of a scan beside the allometry [-], by their variances: logarithm of 1.45, the excess of
wood of scanned and felled ashes, and 0.3 of repeated scans (Demol et al. 2022), beside 0.24.
"""

_LENGTH = 21.0
_POWER = 0.92
_CLIPPED = 0.3
"""Share of the ends of one thickness from which a fit has a lower bound [-]."""
_MOST_TWIGS = 1000
_MOST_AT_AN_END = 40
_MOST_THINNER = 3.0
"""Largest number of times that twigs are made thinner, or thicker [-]."""
_FEWEST = 10
"""Number of branches by which the end of a scan is known [-]."""
_MOST_EXCESS = 0.025
"""Largest length in [m] by which branches are made thinner: no beam widens them by more."""
_SMALLEST = 0.07, 5.0
"""Diameter and height in [m] from which on the allometry holds."""
_OPENING = math.radians(35.0)
_GOLDEN = math.pi * (3.0 - math.sqrt(5.0))


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
    thinner
        Length by which all branches were made thinner in [m].
    wood
        Volume of the tree over that as scanned [-].
    is_cut
        Whether the scan ends at a thickness.

    """

    end: float
    grown: float
    thinner: float
    wood: float
    is_cut: bool

    def sentence(self) -> str:
        """Say what was grown, in one sentence."""
        thinner = ''
        if self.thinner > 0.0:
            thinner = (
                f'by the allometry of its size branches are {1e3 * self.thinner:.2g} mm thinner '
                f'and it has {self.wood:.2f} times the scanned wood; '
            )
        return (
            f'the scan ends at {1e3 * self.end:.3g} mm; {thinner}{100.0 * self.grown:.0f} % of '
            'the area of its crown is grown beyond it (beyond_scan=none leaves it)'
        )


def is_cut(tree: Tree) -> bool:
    """Whether a scan ends at a thickness; else its thinnest wood are its twigs."""
    last = tree.branch_first[1:] - 1
    ends = tree.tip_diameter[last]
    thinnest = float(np.percentile(ends, 2.0))
    widest = np.maximum(tree.base_diameter[last], ends)
    if (np.abs(widest - thinnest) < 1e-3 * thinnest).mean() > _CLIPPED:
        return False
    return float(np.median(ends)) >= CUT_AT


def grown_beyond(tree: Tree, twig: float) -> tuple[Tree, Beyond | None]:
    """
    Grow the wood beyond the ends of a scan.

    Parameters
    ----------
    tree
        Tree as scanned, its twigs corrected.
    twig
        Diameter of the last twigs in [m].

    Returns
    -------
    tuple
        The tree with its twigs, and what was grown; the tree itself and None if it has no ends
        thicker than two twigs.

    """
    last = tree.branch_first[1:] - 1
    seen = _open_diameter(tree, last)
    ends = last[seen > 2.0 * twig]
    if len(ends) == 0 or twig <= 0.0:
        return tree, None
    end = float(np.median(seen[seen > 2.0 * twig]))
    cut = is_cut(tree)
    length, volume, area = _beyond(tree, ends, twig, cut=cut)
    thinner = tree
    excess = 0.0
    factor = 1.0
    usual = _usual(tree)
    if usual is not None:
        wood, crown = usual
        if cut:
            wanted = _between(float(tree.volume.sum() + volume.sum()), wood)
            most = min(max(end - 2.0 * twig, 0.0), _MOST_EXCESS)
            excess = _excess(tree, ends, twig, wanted, most)
        wanted = _between(_crown_area(tree) + float(area.sum()), crown)
        thinner = _thinned(tree, excess, twig)
        length, volume, area = _beyond(thinner, ends, twig, cut=cut)
        factor = (wanted - _crown_area(thinner)) / float(area.sum())
        factor = min(max(factor, 1.0 / _MOST_THINNER), _MOST_THINNER)
    grown = _with_twigs(thinner, ends, length, volume, factor * area)
    share = 1.0 - _crown_area(thinner) / _crown_area(grown)
    left = float(grown.volume.sum() / tree.volume.sum())
    return grown, Beyond(end, share, excess, left, cut)


def is_to_be_grown(tree: Tree) -> bool:
    """Whether a scan of many branches was cut, and trees of its species and size are known."""
    return tree.n_branches >= _FEWEST and is_cut(tree) and _usual(tree) is not None


def _usual(tree: Tree) -> tuple[float, float] | None:
    """Volume in [m^3] of a tree of its size and area of its crown in [m^2]; None without a law."""
    diameter = breast_height_diameter(tree)
    if diameter is None or species_named(tree.species).habit != 'broadleaf':
        return None
    crown = crown_size(tree.species, diameter, tree.height)
    if crown is None or diameter < _SMALLEST[0] or tree.height < _SMALLEST[1]:
        return None
    return wood_volume(diameter, tree.height), crown.wood_area


def _between(scanned: float, usual: float) -> float:
    return scanned**SCAN_WEIGHT * usual ** (1.0 - SCAN_WEIGHT)


def _excess(tree: Tree, ends: Ints, twig: float, wanted: float, most: float) -> float:
    """Find by which length [m] all branches are too thick, for a wanted volume [m^3]."""
    low = 0.0
    high = most
    for _ in range(40):
        middle = 0.5 * (low + high)
        thinner = _thinned(tree, middle, twig)
        volume = thinner.volume.sum() + _beyond(thinner, ends, twig, cut=True)[1].sum()
        low, high = (middle, high) if volume > wanted else (low, middle)
    return low


def _thinned(tree: Tree, excess: float, twig: float) -> Tree:
    """Return the tree with branches thinner by a length [m], no less than a twig."""
    is_branch = np.arange(tree.n_segments) >= tree.branch_first[1]
    base, tip = (
        np.where(is_branch, np.maximum(each - excess, np.minimum(each, twig)), each)
        for each in (tree.base_diameter, tree.tip_diameter)
    )
    return replace(tree, base_diameter=base, tip_diameter=tip)


def _open_diameter(tree: Tree, last: Ints) -> Floats:
    """Diameter at the end of each branch in [m], less the section of branches that begin there."""
    section = tree.tip_diameter**2
    first = tree.branch_first[1:-1]
    above = tree.segment_parent[first]
    gap = np.linalg.norm(tree.start[first] - tree.end[above], axis=1)
    continues = gap <= 0.1 * tree.length[above]
    np.subtract.at(section, above[continues], tree.base_diameter[first[continues]] ** 2)
    return np.sqrt(np.maximum(section[last], 0.0))


def _crown_area(tree: Tree) -> float:
    """Diameter times length of all wood but the stem in [m^2]."""
    wide = 0.5 * (tree.base_diameter + tree.tip_diameter) * tree.length
    return float(wide[tree.branch_first[1] :].sum())


def _beyond(tree: Tree, ends: Ints, twig: float, *, cut: bool) -> tuple[Floats, Floats, Floats]:
    """Length to go [m], volume [m^3] and area [m^2] beyond the ends of some branches."""
    last = tree.branch_first[1:] - 1
    d = np.maximum(_open_diameter(tree, last)[np.isin(last, ends)], twig)
    pipe = np.minimum(d, max(float(np.percentile(d, 25.0)), 2.0 * twig)) if cut else d
    length = _LENGTH * (pipe**_POWER - twig**_POWER)
    rest = 1.0 - _POWER
    area = _LENGTH * _POWER * d**2 * (twig**-rest - pipe**-rest) / rest
    return length, 0.25 * math.pi * d**2 * length, area


def _with_twigs(tree: Tree, ends: Ints, length: Floats, volume: Floats, area: Floats) -> Tree:
    """Return the tree with equal twigs of a volume and an area at the end of some segments."""
    has = area > 1e-9
    ends = ends[has]
    length = length[has]
    volume = volume[has]
    if len(ends) == 0:
        return tree
    thick = 4.0 / math.pi * volume / area[has]
    section = 4.0 / math.pi * volume
    count = np.clip(np.rint(section / (thick**2 * length)), 1, _MOST_AT_AN_END)
    if count.sum() > _MOST_TWIGS:
        count = np.maximum(np.floor(count * _MOST_TWIGS / count.sum()), 1)
    # Fewer twigs are longer, up to twice; then they are thicker, at the same wood.
    reach = np.minimum(section / (thick**2 * count), 2.0 * length)
    thick = np.sqrt(section / (reach * count))
    count = count.astype(np.int64)
    at = np.repeat(np.arange(len(ends)), count)
    number = np.arange(len(at)) - np.repeat(np.cumsum(count) - count, count)
    along = tree.direction[ends][at]
    opening = np.where(count[at] == 1, 0.0, _OPENING).astype(np.float64)
    way = _around(along, opening, _GOLDEN * np.arange(len(at), dtype=np.float64))
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
