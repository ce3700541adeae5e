# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Strength that the tree of a kind uses by wind speed, in leaf and bare, in any process.

A tree is grown by species, height and stem, set up, and blown by gusts of two mean winds: the
first is usual, the other near that at which it falls. Its mean is that at 10 m in the open and in
a street, and that at the top of the trees at the edge of a stand and inside it (`exposure`).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from tree_sway.core.setup import standing_tree
from tree_sway.core.species import species_named
from tree_sway.core.tree import rooted, Tree
from tree_sway.errors import TreeError, TreeSwayError
from tree_sway.files.trees import TreeFile
from tree_sway.growth import BREAST_HEIGHT, grow, stem_range
from tree_sway.simulation import Exposure, exposure_of, Rig, ShareCurve, STATION_HEIGHT

_MODEL = 20
_RATE = 10.0
"""Steps per second [Hz]; stems sway less than once a second."""
_FIRST = 25.0
_SLOWEST = 4.0
_FASTEST = 40.0
_USUAL_POWER = 1.5
"""Power of the wind speed that the load of a crown grows by, between 1 and 2."""


_IN_THE_OPEN = Exposure(anemometer_height=STATION_HEIGHT)


@dataclass(frozen=True)
class RiskKind:
    """
    Trees of one species, form and exposure.

    ``height`` in [m], ``slenderness`` height over diameter, 0 if unknown; ``exposure`` one of
    `EXPOSURES`; ``spacing`` of the trees of a stand in [m], 0 for the usual one.
    """

    species: str
    height: float
    slenderness: float
    seed: int = 0
    exposure: str = 'open'
    spacing: float = 0.0


@dataclass(frozen=True)
class SeasonCurves:
    """Shares of strength of the stem and of roots by the mean wind, with leaves or without."""

    in_leaf: bool
    stem: ShareCurve
    roots: ShareCurve


@dataclass(frozen=True)
class KindResult:
    """
    What a kind of trees uses, or why it cannot be computed.

    ``slenderness`` is height over diameter at breast height of the grown tree, ``exposure`` that
    of the kind, ``note`` what was changed to grow it; ``error`` is empty if all went well.
    """

    kind: RiskKind
    seasons: tuple[SeasonCurves, ...] = ()
    slenderness: float = 0.0
    exposure: Exposure = _IN_THE_OPEN
    note: str = ''
    error: str = ''


def compute_kind(kind: RiskKind) -> KindResult:
    """Compute the curves of a kind; an impossible one has the error instead."""
    try:
        return _computed(kind)
    except TreeSwayError as error:
        return KindResult(kind, error=str(error))


def _computed(kind: RiskKind) -> KindResult:
    species = species_named(kind.species)
    note = ''
    diameter = None
    if kind.slenderness:
        low, high = stem_range(species, kind.height)
        wanted = kind.height / kind.slenderness
        diameter = min(max(wanted, low), high)
        if not low <= wanted <= high:
            note = f'a stem of {wanted:.3g} m would buckle: of {diameter:.3g} m, scaled'
    rng = np.random.default_rng(kind.seed)
    tree = grow(kind.species, kind.height, diameter, rng=rng)
    try:
        return _blown(kind, tree, note)
    except TreeError:
        limbs = 'grown limbs that could not carry themselves are thickened'
        tree, _ = standing_tree(tree, species, in_leaf=True)
        return _blown(kind, tree, f'{note}; {limbs}' if note else limbs)


def _blown(kind: RiskKind, tree: Tree, note: str) -> KindResult:
    species = species_named(kind.species)
    whole = TreeFile(tree, rooted(tree, species), kind.species)
    seasons = (True,) if species.leaves.is_evergreen else (True, False)
    exposure = exposure_of(
        tree,
        species,
        kind.exposure,
        spacing=kind.spacing or None,
        anemometer_height=STATION_HEIGHT if kind.exposure == 'open' else None,
    )
    whole = replace(whole, species=exposure.in_contact(whole.species))
    curves = tuple(_season(whole, kind.seed, in_leaf, exposure) for in_leaf in seasons)
    return KindResult(kind, curves, kind.height / _diameter(tree), exposure, note)


def _season(tree: TreeFile, seed: int, in_leaf: bool, exposure: Exposure) -> SeasonCurves:
    ground = float(tree.tree.start[0, 2])
    rig = Rig(tree, model=_MODEL, in_leaf=in_leaf, profile=exposure.profile(ground))
    shares = dict[float, tuple[float, float]]()
    speed = _FIRST
    for _ in range(2):
        shares[speed] = _shares(rig, exposure, speed, seed)
        guess = speed * max(*shares[speed], 1e-3) ** (-1.0 / _USUAL_POWER)
        apart = max(guess, 1.1 * speed) if guess > speed else min(guess, speed / 1.1)
        speed = float(np.clip(apart, _SLOWEST, _FASTEST))
    return SeasonCurves(in_leaf, _curve(shares, 0), _curve(shares, 1))


def _shares(rig: Rig, exposure: Exposure, speed: float, seed: int) -> tuple[float, float]:
    """Shares of stem and roots in the largest gust of ten minutes of a mean wind [m/s]."""
    (used,) = rig.strength_curve(
        [speed],
        rng=np.random.default_rng(seed),
        rate=_RATE,
        strained=1,
        **exposure.turbulence,
    )
    return used.stem, float(used.roots[0])


def _curve(shares: dict[float, tuple[float, float]], part: int) -> ShareCurve:
    speeds = sorted(shares)
    return ShareCurve(np.array(speeds), np.array([shares[speed][part] for speed in speeds]))


def _diameter(tree: Tree) -> float:
    """Diameter of the stem where `grow` takes it: at breast height, or at the base if low [m]."""
    stem = tree.segments_of(0)
    if tree.height <= 2.0 * BREAST_HEIGHT:
        return float(tree.base_diameter[0])
    level = tree.start[stem, 2] - tree.start[0, 2]
    return float(np.interp(BREAST_HEIGHT, np.maximum.accumulate(level), tree.base_diameter[stem]))
