# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
How steeply the response spectrum of a grown tree falls above its first frequency.

Measured as on real trees: the strain of the stem at its base along the wind and across it, in
turbulence that lasts, and the power between 1.3 and 3.5 times the first frequency as a straight
line in logarithms. The same line through one-hour records of the strain of 68 forest trees (data
of Jackson et al. 2021, Biogeosciences 18, 4059-4072) has a median slope of -4.0 for conifers (nine
tenths of them between -5.5 and -1.6) and of -3.3 for broadleaved trees (-5.3 to -0.5); a single
oscillator has -6.4 to -7. The highest tip has another slope. In broadleaves it is up to 4 steeper,
as a mode of frequency f strains the stem by f^2 times the displacement of its top; in a pine it is
flatter, as the limb that carries the tip swings too.

"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.signal import welch

from tree_sway.core.arrays import Floats
from tree_sway.core.settings import Settings
from tree_sway.core.species import species_named
from tree_sway.core.wind import simulate_turbulence
from tree_sway.growth import grow
from tree_sway.simulation import Rig

SPECIES = (
    'spruce', 'sitka', 'pine', 'douglas_fir', 'birch', 'oak', 'beech', 'ash', 'sycamore', 'walnut',
)  # fmt: skip
HEIGHTS = {'conifer': 15.0, 'broadleaf': 12.0}
BAND = (1.3, 3.5)
"""Band of the fit, over the first frequency."""

_RATE = 20.0


class Slopes(NamedTuple):
    """
    Slopes in [-] along the wind and across it, (2,), and the first frequency in [Hz].

    Parameters
    ----------
    strain
        Slopes of the strain of the stem at its base.
    tip
        Slopes of the displacement of the highest tip.
    first
        First frequency in [Hz].

    """

    strain: tuple[float, float]
    tip: tuple[float, float]
    first: float


def response_slopes(
    species: str, *, coherence: float, in_leaf: bool, mean_speed: float = 7.0,
    seconds: float = 600.0, seed: int = 1,
) -> Slopes:  # fmt: skip
    """
    Let a grown tree sway and measure its slopes.

    Parameters
    ----------
    species
        One of `SPECIES`.
    coherence
        As in `Settings.crown_coherence`.
    in_leaf
        Whether it bears leaves.
    mean_speed, seconds
        Mean speed [m/s] and duration [s] of the wind.
    seed
        Seed of the tree and the wind.

    """
    tree = grow(species, HEIGHTS[species_named(species).habit], rng=np.random.default_rng(seed))
    rig = Rig(tree, Settings(crown_coherence=coherence, in_leaf=in_leaf))
    wind = simulate_turbulence(
        mean_speed, rate=_RATE, duration=seconds, rng=np.random.default_rng(seed)
    )
    record = rig.run(wind, rate=_RATE)
    first = float(rig.reductions.natural_frequencies(1)[0])

    def slopes(signal: Floats) -> tuple[float, float]:
        along, across = (slope_above(signal[:, k], first, _RATE) for k in (0, 1))
        return along, across

    return Slopes(slopes(record.base_strain), slopes(record.tips[:, 0]), first)


def slope_above(signal: Floats, first: float, rate: float) -> float:
    """Slope in logarithms of the spectrum of a signal (n,) over `BAND` times a frequency [Hz]."""
    frequency, power = welch(signal, rate, nperseg=min(round(30.0 * rate / first), len(signal)))
    band = (frequency > BAND[0] * first) & (frequency < BAND[1] * first)
    # Weights that are even in the logarithm of the frequency, as most lines are at its upper end.
    weight = 1.0 / np.sqrt(frequency[band])
    return float(np.polyfit(np.log(frequency[band]), np.log(power[band]), 1, w=weight)[0])
