# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Two rules that draw a scan which was cut to the wood of trees of its diameter and height.

They were written down before they were scored (``sections/cut_scans.md``). The program has
neither.
"""

from __future__ import annotations

from dataclasses import replace
import math

import numpy as np

from tree_sway.core.arrays import Floats, Ints
from tree_sway.core.tree import Tree, tree_from_segments
from tree_sway.growth import breast_height_diameter, crown_size, open_diameter

SCAN_WEIGHT = 0.2
"""Weight of a scan beside the allometry [-]."""
TWIG = 0.0029
"""Diameter of the twigs of a broadleaf of no known species [m]."""

_LENGTH, _POWER = 21.0, 0.92
"""Length from a diameter of 1 m to its tips [m], and its power of the diameter [-]."""
_MOST_TWIGS, _MOST_AT_AN_END, _MOST_THINNER = 1000, 40, 3.0
_THINNEST = 0.5
_OPENING, _GOLDEN = math.radians(35.0), math.pi * (3.0 - math.sqrt(5.0))


def by_one_ratio(tree: Tree) -> Tree:
    """Return the tree with all branches thinner by one ratio: the second rule."""
    first = tree.branch_first[1]
    wanted = _between(float(tree.volume.sum()), wood_volume(tree))
    left = max(wanted - float(tree.volume[:first].sum()), 0.0)
    ratio = math.sqrt(left / float(tree.volume[first:].sum()))
    ratios = np.where(_is_branch(tree), min(max(ratio, _THINNEST), 1.0), 1.0)
    return _with_diameters(tree, ratios * tree.base_diameter, ratios * tree.tip_diameter)


def by_one_length(tree: Tree) -> Tree:
    """Return the tree with branches thinner by one length, and twigs beyond: the first rule."""
    open_end = open_diameter(tree)
    ends = np.flatnonzero(open_end > 2.0 * TWIG)
    most = max(float(np.median(open_end[ends])) - 2.0 * TWIG, 0.0)
    _, volume, area = _beyond(tree, ends)
    wanted = _between(float(tree.volume.sum() + volume.sum()), wood_volume(tree))
    wanted_area = _between(_crown_area(tree) + float(area.sum()), _usual_area(tree))
    low, high = 0.0, most
    for _ in range(40):
        middle = 0.5 * (low + high)
        thinner = _thinned(tree, middle)
        total = thinner.volume.sum() + _beyond(thinner, ends)[1].sum()
        low, high = (middle, high) if total > wanted else (low, middle)
    thinner = _thinned(tree, low)
    length, volume, area = _beyond(thinner, ends)
    factor = (wanted_area - _crown_area(thinner)) / float(area.sum())
    area *= min(max(factor, 1.0 / _MOST_THINNER), _MOST_THINNER)
    return _with_twigs(thinner, ends, length, volume, area)


def wood_volume(tree: Tree) -> float:
    """Volume of trees of its diameter and height in [m^3] (Chave et al. 2014, equation 4)."""
    diameter = breast_height_diameter(tree) or 0.0
    return 0.0673 * (0.55 * (100.0 * diameter) ** 2 * tree.height) ** 0.976 / 550.0


def _usual_area(tree: Tree) -> float:
    crown = crown_size('broadleaf', breast_height_diameter(tree) or 0.0, tree.height)
    return crown.wood_area if crown else 0.0


def _between(scanned: float, usual: float) -> float:
    return scanned**SCAN_WEIGHT * usual ** (1.0 - SCAN_WEIGHT)


def _is_branch(tree: Tree) -> np.ndarray:
    return np.arange(tree.n_segments) >= tree.branch_first[1]


def _with_diameters(tree: Tree, base: Floats, tip: Floats) -> Tree:
    return replace(tree, base_diameter=base, tip_diameter=tip)


def _thinned(tree: Tree, excess: float) -> Tree:
    base, tip = (
        np.where(_is_branch(tree), np.maximum(each - excess, np.minimum(each, TWIG)), each)
        for each in (tree.base_diameter, tree.tip_diameter)
    )
    return _with_diameters(tree, base, tip)


def _crown_area(tree: Tree) -> float:
    wide = 0.5 * (tree.base_diameter + tree.tip_diameter) * tree.length
    return float(wide[_is_branch(tree)].sum())


def _beyond(tree: Tree, ends: Ints) -> tuple[Floats, Floats, Floats]:
    """Length to go [m], volume [m^3] and area [m^2] of the pipes beyond the ends of branches."""
    d = np.maximum(open_diameter(tree)[ends], TWIG)
    pipe = np.minimum(d, max(float(np.percentile(d, 25.0)), 2.0 * TWIG))
    length = _LENGTH * (pipe**_POWER - TWIG**_POWER)
    rest = 1.0 - _POWER
    area = _LENGTH * _POWER * d**2 * (TWIG**-rest - pipe**-rest) / rest
    return length, 0.25 * math.pi * d**2 * length, area


def _with_twigs(tree: Tree, ends: Ints, length: Floats, volume: Floats, area: Floats) -> Tree:
    """Return the tree with equal twigs of a volume, and as far as may be an area, at its ends."""
    has = area > 1e-9
    at_segment = (tree.branch_first[1:] - 1)[ends][has]
    length = length[has]
    section = 4.0 / math.pi * volume[has]
    thick = section / area[has]
    count = np.clip(np.rint(section / (thick**2 * length)), 1, _MOST_AT_AN_END)
    if count.sum() > _MOST_TWIGS:
        count = np.maximum(np.floor(count * _MOST_TWIGS / count.sum()), 1)
    reach = np.minimum(section / (thick**2 * count), 2.0 * length)
    thick = np.sqrt(section / (reach * count))
    count = count.astype(np.int64)
    at = np.repeat(np.arange(len(count)), count)
    number = np.arange(len(at)) - np.repeat(np.cumsum(count) - count, count)
    along = tree.direction[at_segment][at]
    reference = np.where(np.abs(along[:, 2:]) > 0.9, [1.0, 0.0, 0.0], [0.0, 0.0, 1.0])
    across = np.cross(along, reference)
    across /= np.linalg.norm(across, axis=1)[:, None]
    turn = _GOLDEN * np.arange(len(at))[:, None]
    side = np.cos(turn) * across + np.sin(turn) * np.cross(along, across)
    opening = np.where(count[at] == 1, 0.0, _OPENING)[:, None]
    way = np.cos(opening) * along + np.sin(opening) * side
    start = tree.end[at_segment][at]
    width = np.stack([thick[at]] * 2, axis=1)
    owner = tree.branch_of_segment[at_segment][at]
    names = [f'{tree.branch_names[b]}_{n}' for b, n in zip(owner, number + 1, strict=True)]
    both = np.stack([tree.base_diameter, tree.tip_diameter], axis=1)
    return tree_from_segments(
        np.vstack([tree.start, start]),
        np.vstack([tree.end, start + reach[at][:, None] * way]),
        np.vstack([both, width]),
        parent=np.concatenate([tree.segment_parent, at_segment[at]]),
        branch=np.concatenate([tree.branch_of_segment, tree.n_branches + np.arange(len(at))]),
        branch_names=[*tree.branch_names, *names], name=tree.name, species=tree.species,
    )  # fmt: skip
