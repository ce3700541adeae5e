# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Background, peak and slope of the strain at the base of grown trees, in the open and in a stand.

The spectrum of strain has a slow part, in which the tree follows the gusts (background), a peak at
its first frequency f1 and a decay above it. In one-hour records of real trees (Jackson et al.
2021, Biogeosciences 18, 4059-4072) a share of 0.45 to 0.55 of the variance is below 0.6 f1 in
forests and of 0.64 to 0.71 in the open, and three records of four have a clear peak.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.signal import welch

from tree_sway.core.arrays import Floats
from tree_sway.core.scene import PlacedTree
from tree_sway.core.settings import Settings
from tree_sway.core.species import species_named
from tree_sway.core.tree import rooted
from tree_sway.core.wind import simulate_turbulence
from tree_sway.growth import grow
from tree_sway.simulation import exposure_of, Rig
from tree_sway_lab.validation.response_slopes import HEIGHTS, slope_above

SPECIES = ('spruce', 'sitka', 'pine', 'douglas_fir', 'birch', 'oak', 'beech', 'ash')
BACKGROUND = 0.6
"""Over the first frequency: below it is the background."""
CLEAR_PEAK = 2.0
"""Power of a clear peak over the least between background and peak [-]."""

_MODEL, _RATE, _SPEED = 20, 20.0, 7.0


class GustCase(NamedTuple):
    """A species, where its tree stands, and the coherence of gusts over its crown [-]."""

    species: str
    exposure: str
    coherence: float


class GustResponse(NamedTuple):
    """
    What the strain at the base of a tree shows, the mean of along and across the wind.

    Parameters
    ----------
    share
        Share of the variance below `BACKGROUND` times the first frequency [-].
    slope
        Slope of the spectrum above it in logarithms [-].
    peak
        Power of the peak over the least of the spectrum below it [-].
    first
        First frequency in [Hz].

    """

    share: float
    slope: float
    peak: float
    first: float

    @property
    def has_clear_peak(self) -> bool:
        """Whether the peak stands out."""
        return self.peak >= CLEAR_PEAK


def gust_response(case: GustCase, seconds: float = 600.0, seed: int = 1) -> GustResponse:
    """Let a grown tree in leaf sway in turbulence of its site, of 7 m/s where it is measured."""
    wood = species_named(case.species)
    tree = grow(case.species, HEIGHTS[wood.habit], rng=np.random.default_rng(seed))
    species = rooted(tree, wood)
    site = exposure_of(tree, species, case.exposure)
    settings = Settings(
        model=_MODEL,
        in_leaf=True,
        crown_coherence=case.coherence,
        profile=site.profile(float(tree.start[0, 2])),
    )
    rig = Rig(PlacedTree(case.species, tree, species=site.in_contact(species)), settings)
    wind = simulate_turbulence(
        _SPEED,
        rate=_RATE,
        duration=seconds,
        rng=np.random.default_rng(seed),
        **site.turbulence,
    )
    record = rig.run(wind, rate=_RATE)
    first = float(rig.reductions.natural_frequencies(1)[0])
    both = [_response(record.base_strain[:, k], first) for k in (0, 1)]
    share, slope, peak = np.mean(both, axis=0).tolist()
    return GustResponse(share, slope, peak, first)


def _response(strain: Floats, first: float) -> tuple[float, float, float]:
    """Background share, slope and peak of a strain (n,) by the first frequency [Hz]."""
    power = np.square(np.abs(np.fft.rfft(strain - strain.mean())))
    frequency = np.fft.rfftfreq(len(strain), 1.0 / _RATE)
    share = float(power[frequency < BACKGROUND * first].sum() / power.sum())
    frequency, power = welch(strain, _RATE, nperseg=min(round(30.0 * _RATE / first), len(strain)))
    relative = frequency / first
    top = power[(relative > 0.75) & (relative < 1.25)].max()
    least = power[(relative > 0.3) & (relative < 0.9)].min()
    return share, slope_above(strain, first, _RATE), float(top / least)
