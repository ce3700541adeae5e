# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
How steeply the response spectrum of a grown tree falls above its first frequency.

The tip's displacement along the wind and across it, in turbulence that lasts; the power between 1.3
and 3.5 times the first frequency, as a straight line in logarithms. Stems of real trees fall with
powers of -4.4 to -2.0, one oscillator alone with -6.4 to -7.

"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.signal import welch

from tree_sway_ros.core.arrays import Floats
from tree_sway_ros.core.growth.grow import grow
from tree_sway_ros.core.simulator.settings import Settings
from tree_sway_ros.core.simulator.simulator import SwaySimulator
from tree_sway_ros.core.tree.species import species_named
from tree_sway_ros.core.wind.simulated.turbulence import simulate_turbulence

SPECIES = (
    "spruce", "sitka", "pine", "douglas_fir", "birch", "oak", "beech", "ash", "sycamore", "walnut",
)  # fmt: skip
HEIGHTS = {"conifer": 15.0, "broadleaf": 12.0}
BAND = (1.3, 3.5)
"""Over the first frequency."""

_RATE = 30.0


class Slopes(NamedTuple):
    """Slopes along the wind and across it in [-], and the first frequency in [Hz]."""

    along: float
    across: float
    first: float


def response_slopes(
    species: str, *, coherence: float, in_leaf: bool, mean_speed: float = 7.0,
    seconds: float = 1200.0, seed: int = 1,
) -> Slopes:  # fmt: skip
    """
    Let a grown tree sway and measure its slopes.

    Parameters
    ----------
    species
        One of `SPECIES`.
    coherence
        As of `Settings.crown_coherence`.
    in_leaf
        Whether it bears leaves.
    mean_speed, seconds
        Of the wind in [m/s], and how long it lasts in [s].
    seed
        Of the tree and of the wind.

    """
    wood = species_named(species)
    tree = grow(species, HEIGHTS[wood.habit], rng=np.random.default_rng(seed))
    settings = Settings(crown_coherence=coherence, in_leaf=in_leaf, n_modes=40)
    sim = SwaySimulator(tree, wood, settings)
    wind = simulate_turbulence(
        mean_speed, rate=_RATE, duration=seconds, rng=np.random.default_rng(seed)
    )
    tips = np.empty((len(wind), 2))
    for step, mean in enumerate(wind):
        sim.step(mean, 1.0 / _RATE)
        tips[step] = sim.tip_displacement[:2]
    first = float(sim.frequencies(1)[0])
    along, across = (slope_above(tips[:, k], first, _RATE) for k in (0, 1))
    return Slopes(along, across, first)


def slope_above(signal: Floats, first: float, rate: float) -> float:
    """Slope in logarithms of the spectrum of a signal (n,) over `BAND` times a frequency [Hz]."""
    frequency, power = welch(signal, rate, nperseg=min(round(30.0 * rate / first), len(signal)))
    band = (frequency > BAND[0] * first) & (frequency < BAND[1] * first)
    # Even in the logarithm of the frequency: the many lines at its end must not outweigh the rest.
    weight = 1.0 / np.sqrt(frequency[band])
    return float(np.polyfit(np.log(frequency[band]), np.log(power[band]), 1, w=weight)[0])
