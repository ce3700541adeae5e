# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Response to gusts of a tree that leans in a steady wind, by its table.

At an equilibrium e of the table, in a wind of speed U and dynamic pressure ``s = p U^2``, small
motion q about it obeys, with the slopes of the load there (`load_table`)::

    q'' + (D - p U B) q' + (K - s A) q = f(t)

K, D the stiffness and damping of the coordinates, A and B the slopes of the load by the
coordinates and their rates. A gust (u, v, w) changes the load: along the wind by
``(ds/dU / s) K e u``, for the load of the equilibrium is ``K e`` and proportional to s; across it
by a turn of the azimuth a, ``(K - s A) de/da v / U``; vertically by a turn of the elevation,
``w / U``. The spectrum of the gusts is that of the inertial subrange, ``f^(-5/3)`` of the
frequency f, constant below the slowest coordinate.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.arrays import Floats
from tree_sway.core.drag import drag_density, DragLaw
from tree_sway.core.model import N_AZIMUTHS
from tree_sway.core.setup.load_table import SPEEDS
from tree_sway.core.setup.spherical_harmonics import harmonics_at
from tree_sway.core.setup.static_responses import direction

N_FREQUENCIES, _BEYOND = 20, 1.5
"""Number of frequencies, and their range beyond those of the coordinates."""

_INTENSITY = 0.25 * np.array([1.0, 0.8, 0.5])
"""
Turbulence intensity along, across and up: ratios of the surface layer (Panofsky & Dutton 1984,
Atmospheric Turbulence, 7.1).

"""

_TURN = 1e-3
"""Turn of the elevation [rad], and change of the speed over itself, for difference quotients."""


class Leaning(NamedTuple):
    """Equilibria in a steady wind from every azimuth, and the response to gusts about them."""

    speed: float
    """Steady wind [m/s]."""
    poses: Floats
    """Coordinates of the equilibria, (a, m)."""
    gusts: NDArray[np.complex128]
    """
    Amplitudes by azimuth, frequency and component of the gust, (a, f, m, 3); the sum of their
    squared sizes is the variance of the coordinates.
    """


def leaning_responses(
    table: Mapping[str, Any],
    stiffness: Floats,
    damping: Floats,
    law: DragLaw,
    speeds: tuple[float, ...],
) -> Iterator[Leaning]:
    """
    Find the responses at the equilibria of some of the `SPEEDS` of a table.

    Parameters
    ----------
    table
        Arrays of a `SwayModel` of the group table.
    stiffness, damping
        Stiffness of each coordinate in [1/s^2] and its damping in [1/s], (m,).
    law
        Drag law of the tree.
    speeds
        Speeds among `SPEEDS`, above 0.

    """
    m = len(damping)
    slowest = float(np.sqrt(stiffness.min()))
    fastest = float(np.sqrt(stiffness.max()))
    swept = np.geomspace(slowest / _BEYOND, _BEYOND * fastest, N_FREQUENCIES)
    # Root of the spectrum f^(-5/3) over bands of width f.
    spectrum = np.maximum(swept, slowest) ** (-1.0 / 3.0)
    amplitude = spectrum[:, None, None] / np.linalg.norm(spectrum) * _INTENSITY
    swept = swept[:, None, None]
    inertia = np.square(swept) * np.eye(m)
    for speed in speeds:
        level = SPEEDS.index(speed)
        per_speed = drag_density(speed, *law)
        dynamic_pressure = per_speed * speed**2
        growth = _growth(speed, law)
        poses = table['equilibrium'][:, level]
        turned = _by_azimuth(poses)
        gusts = np.zeros((N_AZIMUTHS, N_FREQUENCIES, m, 3), dtype=np.complex128)
        for azimuth, pose in enumerate(poses):
            slopes = table['turning'][azimuth, level].T.astype(np.float64)
            by_rates = table['damping'][azimuth, level].T.astype(np.float64)
            springs = np.diag(stiffness) - dynamic_pressure * slopes
            dampers = np.diag(damping) - per_speed * speed * by_rates
            along = growth * stiffness * pose
            across = springs @ turned[azimuth]
            upward = dynamic_pressure * _by_elevation(table, azimuth, pose)
            load = np.stack([along, across, upward], axis=1)
            system = springs - inertia + 1j * swept * dampers
            gusts[azimuth] = amplitude * np.linalg.solve(system, load.astype(np.complex128))
        yield Leaning(speed, poses, gusts)


def _growth(speed: float, law: DragLaw) -> float:
    """
    Differentiate the dynamic pressure by the speed, both over their own values: U / s ds/dU.

    It is 0 where there is no drag.
    """
    slow = (1.0 - _TURN) * speed
    fast = (1.0 + _TURN) * speed
    low = law.dynamic_pressure(slow)
    high = law.dynamic_pressure(fast)
    total = high + low
    return (high - low) / (_TURN * total) if total > 0.0 else 0.0


def _by_azimuth(poses: Floats) -> Floats:
    """Differentiate values at all azimuths (a, m) by the azimuth [rad]."""
    waves = np.fft.rfft(poses, axis=0)
    order = np.arange(len(waves))
    order[-1] = 0  # the derivative of the highest wave is zero at all azimuths
    return np.asarray(np.fft.irfft(1j * order[:, None] * waves, len(poses), axis=0))


def _by_elevation(table: Mapping[str, Any], azimuth: int, pose: Floats) -> Floats:
    """Differentiate the load at a pose (m,) per dynamic pressure by the elevation [rad]."""
    angle = 2.0 * np.pi * azimuth / N_AZIMUTHS
    up, down = harmonics_at(direction([angle, angle], [_TURN, -_TURN]))
    at_rest = (up - down) / (2.0 * _TURN) @ table['harmonics']
    return np.asarray(at_rest + pose @ table['lean'][azimuth])
