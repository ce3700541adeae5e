# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Wind over a crown: a gust reaches the limbs of a tree one after another.

Two places r apart share a gust of frequency f by the root coherence ``exp(-C f r / U)``, C near 8
(Davenport, 1961, Quarterly Journal of the Royal Meteorological Society 87, 194-211). An anemometer
measures at one place. A share c of its wind reaches the whole crown at once; the rest reaches each
limb after its own delay, from 0 to ``3 C r / (2 pi U)``, so that the coherence of this rest among
limbs decreases with f r / U as in the source. Long gusts reach all limbs alike. The mean over
limbs of short ones has ``c^2 + (1 - c)^2`` of the power, as over an area larger than the gusts.

Delays are assigned to the limbs in the order of the golden ratio: uniform for any number of limbs,
and the same in every run. Delays follow the mean wind as in `gust_travel`.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from tree_sway.core.arrays import Floats, Ints
from tree_sway.core.checks import within
from tree_sway.core.native import address, LIBRARY
from tree_sway.core.tree import Tree

DECAY = 8.0
"""Davenport's C in [-], for places across the wind and over each other."""

USUAL_COHERENCE = 0.3
"""
Share of a gust that reaches the whole crown at once, where gusts reach limb after limb.

At the first frequency of a tree (0.5 to 1 Hz) and 7 m/s the source has a root coherence of 0.03 to
0.18 over 3 m; with a share c it is ``c^2 / (c^2 + (1 - c)^2)``, 0.16 with this one. With it the
spectrum of strain of grown trees decreases above their first frequency as that of real ones
(``tree-sway lab validate --only slopes``).

"""

N_DELAYS = 16
"""Number of delays of limbs."""

_GOLDEN = 0.5 * (math.sqrt(5.0) - 1.0)

_APART = 48
"""Numbers of the winds of limbs, the last ones of the memory of the native core."""

_MEMORY = 1061 + _APART
"""Numbers of that memory."""


class CrownDelays(NamedTuple):
    """
    Delay of each branch, one of `N_DELAYS`, (b,), shares of the load of each, and spread.

    The spread is the longest delay times the wind speed, in [m].
    """

    of_branch: Ints
    share: Floats
    spread: float


def delays_of(tree: Tree, leaf_area: Floats) -> CrownDelays:
    """Assign delays to the branches of a tree, with leaves equivalent to areas (b,) of wood."""
    centre, load = _loads(tree, leaf_area)
    return crown_delays(tree.branch_parent, centre, load)


def _loads(tree: Tree, leaf_area: Floats | float) -> tuple[Floats, Floats]:
    """Centre (b, 3) in [m] and load (b,) of each branch."""
    first = tree.branch_first[:-1]
    diameter = 0.5 * (tree.base_diameter + tree.tip_diameter)
    area = tree.length * diameter
    middle = 0.5 * (tree.start + tree.end)
    wood = np.add.reduceat(area, first)
    moment = np.add.reduceat(middle * area[:, None], first, axis=0)
    centre = moment / np.maximum(wood, 1e-12)[:, None]
    return centre, wood + leaf_area


def parts_of(tree: Tree, leaf_area: Floats | float = 0.0) -> CrownDelays:
    """Part the branches of a tree by their places; leaves, as above, count in the share alone."""
    centre, wood = _loads(tree, 0.0)
    evenly = np.linspace(0, len(centre) - 1, N_DELAYS).astype(np.intp)
    middle = centre[np.unique(evenly)]
    for _ in range(20):
        way = centre[:, None] - middle
        apart = np.linalg.norm(way, axis=2)
        nearest = apart.argmin(axis=1)
        load = np.bincount(nearest, wood, len(middle))
        moments = [np.bincount(nearest, wood * x, len(middle)) for x in centre.T]
        means = moments / np.maximum(load, 1e-12)
        middle = np.where(load > 0.0, means, middle.T).T
    share = _shares(nearest, wood + leaf_area)
    return CrownDelays(nearest, share, 0.0)


def _shares(part: Ints, load: Floats) -> Floats:
    """Share of each of `N_DELAYS` parts in the load of branches, (b,)."""
    loads = np.bincount(part, load, N_DELAYS)
    whole = max(float(loads.sum()), 1e-12)
    return np.asarray(loads / whole)


def limbs_of(parent: Ints) -> Ints:
    """Find the limb of each branch, 0 for the stem, by the parents of branches, (b,)."""
    on_stem = parent == 0
    limb = np.where(on_stem, np.cumsum(on_stem), 0)
    for branch, below in enumerate(parent.tolist()):
        if below > 0:
            limb[branch] = limb[below]
    return limb


def crown_delays(parent: Ints, centre: Floats, load: Floats) -> CrownDelays:
    """
    Assign the delays: the stem has none, and subtrees of limbs have that of the limb.

    Branches have a parent, -1 for the stem, a centre of their wind load [m], (b, 3), and a load of
    any unit, (b,).
    """
    limb = limbs_of(parent)
    n = int(limb.max()) + 1
    total = np.maximum(np.bincount(limb, load, n), 1e-12)
    moments = [np.bincount(limb, load * x, n) for x in centre.T]
    middle = np.stack(moments, axis=1) / total[:, None]
    of_crown = np.average(centre, axis=0, weights=load + 1e-12)
    away = np.linalg.norm(middle - of_crown, axis=1)
    away[0] = 0.0
    farthest = max(float(away.max()), 1e-9)
    even = np.arange(n) * _GOLDEN % 1.0
    wanted = even * away / farthest
    of_limb = np.rint(wanted * (N_DELAYS - 1)).astype(np.int64)
    of_branch = of_limb[limb]
    spread = 3.0 * DECAY * farthest / (2.0 * math.pi)
    return CrownDelays(of_branch, _shares(of_branch, load), spread)


class CrownWind:
    """
    The wind of the last seconds, and the present wind of each limb.

    The spread is that of `CrownDelays`; the coherence, 0 to 1, else a `ParameterError`, is the
    share of the wind without delay.
    """

    def __init__(self, spread: float, coherence: float) -> None:
        """Start without wind."""
        self._spread = spread
        self._coherence = within('crown_coherence', coherence, 0.0, 1.0)
        self._memory = np.zeros(_MEMORY)
        self._wind = np.zeros(3)
        self._at = address(self._memory), address(self._wind)
        self._apart = self._memory[-_APART:].reshape(N_DELAYS, 3)

    def push(self, x: float, y: float, z: float, dt: float) -> Floats:
        """
        Add the mean wind [m/s] of a step of dt [s]; return its change by delay, (`N_DELAYS`, 3).

        The array is reused.
        """
        self._wind[:] = x, y, z
        memory_at, wind_at = self._at
        LIBRARY.sway_limb_winds(memory_at, self._spread, self._coherence, wind_at, dt)
        return self._apart

    def memory(self) -> tuple[Floats, ...]:
        """Return views of the state."""
        return (self._memory,)

    def reset(self) -> None:
        """Forget the wind."""
        self._memory[:] = 0.0
