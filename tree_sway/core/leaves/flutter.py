# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
How leaves flutter: an angle about their stalk from the speed of the air that passes them.

In light to moderate wind the rms speed of a leaf of size D is ``U_leaf = (U / 740)^2 D / nu``,
measured on oak, olive, magnolia, camphor and grass, whatever carries the leaf (Goldshmid et al.
2025, arXiv:2504.10584). A leaf that turns about its stalk by torsional galloping does so near its
own frequency f (Tadrist et al. 2015, on *Ficus benjamina*), its edge at D/2 from the stalk. Speed
over ``2 pi f D/2`` is then the angle, and the size drops out: amplitude ``a = sqrt(2) / (740^2 nu
pi f) U^2``. In strong wind leaves fold together and flutter does not grow (Tadrist et al. 2018):
the amplitude levels off at `LARGEST_ANGLE`, which is an estimate.

The law has two constants, so that it can be computed where leaves are drawn.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.core.arrays import Floats
from tree_sway.core.leaves.foliage import LeafClusters

AIR_VISCOSITY = 1.48e-5
"""Kinematic viscosity of air at 15 degrees C in [m^2/s]."""

_FLUTTER_GAIN = float(np.sqrt(2.0) / (740.0**2 * AIR_VISCOSITY * np.pi))
"""Amplitude times frequency over the square of the wind speed in [rad Hz s^2/m^2]."""

LARGEST_ANGLE = 0.7
"""Amplitude at which flutter levels off in [rad]."""

FLUTTER = {'gain': _FLUTTER_GAIN, 'largest_angle': LARGEST_ANGLE}
"""The two constants of the law, for whoever draws leaves."""


def flutter_amplitude(speed: ArrayLike, frequency: ArrayLike) -> Floats:
    """Amplitude of the flutter [rad] in air at a speed [m/s], for a stalk's frequency [Hz]."""
    speeds = np.asarray(speed, dtype=np.float64)
    frequencies = np.asarray(frequency, dtype=np.float64)
    unlimited = _FLUTTER_GAIN * speeds * speeds / frequencies
    return np.asarray(LARGEST_ANGLE * np.tanh(unlimited / LARGEST_ANGLE))


def flutter_angle(clusters: LeafClusters, speed: ArrayLike, time: float) -> Floats:
    """Angle of each cluster about its stalk [rad], at a time [s] in air past each [m/s], (m,)."""
    amplitude = flutter_amplitude(speed, clusters.frequency)
    phase = 2.0 * np.pi * clusters.frequency * time + clusters.phase
    return np.asarray(amplitude * np.sin(phase))
