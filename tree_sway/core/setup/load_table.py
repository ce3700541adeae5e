# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Table of the loads of all uniform winds on the coordinates of a tree, for `run.table_model`.

In a uniform wind U = |U| d all branches have one wind direction d, and the load is ``Q = s L(d)``
with the dynamic pressure ``s = p(|U|) |U|^2``. L is a smooth function on the sphere, and so is
each projection of it on a mode (Diener, Rodriguez, Baboud & Reveret 2009, *Wind projection basis
for real-time animation of trees*, Computer Graphics Forum 28(2), 533-540). Here it is a sum of
harmonics Y, and the effect of the tree's own motion is added.

For each azimuth of the wind the table stores the equilibria e of the tree in steady winds, calm to
storm; its mean deflection, the lean, increases from one to the next. Between the two equilibria
around the present lean it interpolates the load, its slope by the coordinates (the load rotates
with the tree) and its slope by their rates (aerodynamic damping):

    F = s [Y C + load + turning (eta - e) + d_z lean eta] + p W damping eta'

with W the root mean square of wind and velocity of the branches. For steep winds the slopes are
blended with those of vertical winds.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.drag import DragLaw
from tree_sway.core.model import N_AZIMUTHS, N_LEVELS, TYPES
from tree_sway.core.setup.bent_inertia import inertia_change
from tree_sway.core.setup.equilibrium import EquilibriumSearch
from tree_sway.core.setup.load_derivatives import LoadSlopes
from tree_sway.core.setup.modal_arrays import Coordinates
from tree_sway.core.setup.spherical_harmonics import harmonics_at
from tree_sway.core.setup.static_responses import direction
from tree_sway.core.setup.wind_moments import WindMoments

SPEEDS = (0.0, 3.0, 8.0, 13.0, 20.0, 36.0, 65.0)
"""Steady winds in [m/s] at the levels of the table."""

_BEYOND = 1.1
"""Largest dynamic pressure of the table, over that of the last of `SPEEDS`."""

_AZIMUTHS = 2.0 * np.pi * np.arange(N_AZIMUTHS) / N_AZIMUTHS
_ELEVATIONS = np.deg2rad([0.0, 15.0, 30.0, 45.0, 60.0, 90.0])
_ELEVATION_SPREAD = 0.25
_SLOPE_AT = 0.35
_MOST_ENERGY = 1.5

_BREEZE, _STORM, _FLUTTER = 6.0, 25.0, (0.6, 3.0)
"""
Largest ratio of energy that slopes add to a sway over energy that damping takes, in winds between
the two speeds [m/s] and above: eigenvalues of tables of trees with hanging twigs show flutter from
some three on, and the equilibria of storms depend on smaller ones.

"""

_N_CALM = int(np.searchsorted(SPEEDS, _STORM))
"""Number of `SPEEDS` below a storm."""

LoadsOfWinds = Callable[[Floats], Floats]
"""Loads (k, m) of winds (k, 3) at 1 kg/m^3."""

_LARGE = 2000
"""Branches of a tree above which fewer azimuths suffice."""


def load_table(
    coordinates: Coordinates, wind_moments: WindMoments, drag_law: DragLaw, at_rest: LoadsOfWinds
) -> dict[str, Any]:
    """Find the arrays and numbers of the table of a `SwayModel`; ``at_rest``: `rest_loads`."""
    found = _WindTable(coordinates, wind_moments, drag_law, at_rest).arrays
    return {
        name: each if np.ndim(each) == 0 else np.ascontiguousarray(each, dtype=TYPES[name])
        for name, each in found.items()
    }


class _Standing(NamedTuple):
    """
    Equilibria at the computed azimuths and levels, and the slopes of the load there.

    Parameters
    ----------
    equilibrium
        Coordinates, (a, l, m).
    amount
        Weights of the coordinates in the lean, (a, m).
    turning, damping
        Slopes of the load by the coordinates and by their rates, (a, l, m, m).

    """

    equilibrium: Floats
    amount: Floats
    turning: Floats
    damping: Floats

    @classmethod
    def of_size(cls, n_azimuths: int, n_modes: int) -> _Standing:
        """Return zeros for a number of azimuths and of coordinates."""
        slopes = n_azimuths, N_LEVELS, n_modes, n_modes
        return cls(
            equilibrium=np.zeros(slopes[:3]),
            amount=np.zeros((n_azimuths, n_modes)),
            turning=np.zeros(slopes),
            damping=np.zeros(slopes),
        )


class _WindTable:
    """
    Loads of all uniform winds on a tree, computed once.

    Parameters
    ----------
    bank
        Coordinates of the tree.
    wind_moments
        Loads of the tree.
    drag_law
        C and N of the species.
    at_rest
        Loads on the coordinates of the tree at rest.

    Attributes
    ----------
    arrays
        Arrays and numbers of the table by name.

    """

    def __init__(
        self,
        bank: Coordinates,
        wind_moments: WindMoments,
        drag_law: DragLaw,
        at_rest: LoadsOfWinds,
    ) -> None:
        """Find the loads of the tree in all winds."""
        self._shapes = bank.shapes
        self._moments = wind_moments
        self._inertia_slopes = bank.inertia_slopes
        self._slopes = LoadSlopes(wind_moments, bank.shapes)
        self._stiffness = bank.stiffness
        self._root = np.sqrt(bank.stiffness)
        self._damping = bank.damping
        self._pressures = np.array([drag_law.dynamic_pressure(speed) for speed in SPEEDS])
        self._search = EquilibriumSearch(wind_moments, self._slopes, bank.shapes, bank.stiffness)
        self._still = np.zeros(len(bank.shapes))
        self.arrays = table = dict[str, Any]()
        # Equilibria and slopes are found at some azimuths and interpolated, for they are smooth.
        each = 2 if wind_moments.n_branches <= _LARGE else 3
        self._azimuths = _AZIMUTHS[::each]
        table['motion'] = bank.mean_square_motion
        table['harmonics'], table['limit'] = fit_harmonics(at_rest)
        self._fill_standing(table)
        self._fill_aslant(table)
        table['most_pressure'] = float(_BEYOND * self._pressures[-1])
        energy = table['equilibrium'][:, -1] ** 2 @ bank.stiffness
        table['most_energy'] = _MOST_ENERGY * float(energy.max())

    def _fill_standing(self, table: dict[str, Any]) -> None:
        """Fill loads and their slopes at the equilibria in winds of each speed."""
        standing = self._standing()
        for azimuth in range(len(self._azimuths)):
            for level in range(1, _N_CALM):
                self._turn_inertia(standing, azimuth, level)
        equilibrium = _between(standing.equilibrium)
        table['equilibrium'] = equilibrium
        table['amount'] = _between(standing.amount)
        load = self._loads_at(equilibrium)
        limit = table['limit']
        largest = np.abs(load).max(axis=(0, 1))
        np.maximum(limit, largest, out=limit)
        calm = load[:, :1]
        table['load'] = load - calm
        table['turning'] = _between(standing.turning).astype(np.float32)
        table['damping'] = _without_gain(_between(standing.damping)).astype(np.float32)
        sizes = np.abs(table['damping'])
        of_own_rates = np.einsum('ajii->aji', sizes)
        table['cross_damping'] = (sizes.sum(axis=2) - of_own_rates).astype(np.float64)
        table['levels'] = _rising_levels(table['equilibrium'], table['amount'])

    def _standing(self) -> _Standing:
        """Find the equilibria at the computed azimuths, and the slopes of the load there."""
        found = _Standing.of_size(len(self._azimuths), len(self._stiffness))
        winds = direction(self._azimuths, 0.0)
        loads = self._moments.at_rest(winds, self._shapes)
        for azimuth, (wind, load) in enumerate(zip(winds, loads, strict=True)):
            # One unit of the lean is the pose in a steady wind that bends the tree a little.
            compliance = float(load @ (load / self._stiffness))
            found.amount[azimuth] = load / max(compliance, 1e-300)
            turning = found.turning[azimuth]
            damping = found.damping[azimuth]
            opposite = azimuth - len(winds) // 2
            if opposite >= 0:
                turning[0] = -found.turning[opposite, 0]
                damping[0] = found.damping[opposite, 0]
            else:
                turning[0], damping[0] = self._slopes(self._still, wind)
            self._fill_levels(found, azimuth, wind)
        return found

    def _fill_levels(self, found: _Standing, azimuth: int, wind: Floats) -> None:
        """Fill the equilibria and slopes at one azimuth, each found from that in weaker wind."""
        turning = found.turning[azimuth]
        damping = found.damping[azimuth]
        pose = np.zeros(len(self._stiffness))
        for level in range(1, N_LEVELS):
            weaker = pose
            below = level - 1
            pose = self._search.near(weaker, self._pressures[level], wind, turning[below])
            found.equilibrium[azimuth, level] = pose
            if pose is weaker:
                turning[level] = turning[below]
                damping[level] = damping[below]
            else:
                turning[level], damping[level] = self._damped_slopes(pose, wind, level)

    def _damped_slopes(self, pose: Floats, wind: Floats, level: int) -> tuple[Floats, Floats]:
        """Find the slopes at an equilibrium, without what would feed a flutter of twigs there."""
        slopes = self._slopes(self._shapes @ pose, wind)
        turning, damping = (each.astype(np.float64) for each in slopes)
        speed = SPEEDS[level]
        pressure = self._pressures[level]
        if speed > _BREEZE:
            air = self._damping - pressure / speed * np.diag(damping)
            most = _FLUTTER[speed > _STORM]
            feeding = self._feeding(pressure * turning, air, most)
            turning -= feeding / max(pressure, 1e-300)
        return turning, damping

    def _loads_at(self, equilibrium: Floats) -> Floats:
        """
        Find the loads at the equilibria, (a, l, m).

        In storms they are those of the springs. At lower levels the wind's own load is taken: a
        pose that is interpolated between two azimuths is not exactly at rest.
        """
        pressures = np.maximum(self._pressures, 1e-300)
        load = self._stiffness * equilibrium / pressures[:, None]
        winds = np.repeat(direction(_AZIMUTHS, 0.0), _N_CALM, axis=0)
        rotations = [poses[:_N_CALM] @ self._shapes.T for poses in equilibrium]
        moments = self._moments.at_poses(np.concatenate(rotations), winds)
        by_azimuth = moments.reshape(len(load), _N_CALM, -1)
        for azimuth, moment in enumerate(by_azimuth):
            load[azimuth, :_N_CALM] = moment @ self._shapes
        return np.asarray(load)

    def _turn_inertia(self, standing: _Standing, azimuth: int, level: int) -> None:
        """
        Apply the inertia at an equilibrium to the slopes there, in place.

        Loads and springs accelerate the tree by the inverse inertia A. What that changes in the
        springs, ``K - A K``, is zero at the equilibrium with the load, and is taken per dynamic
        pressure [kg/m/s^2].
        """
        turning = standing.turning[azimuth, level]
        damping = standing.damping[azimuth, level]
        count = len(self._inertia_slopes)
        unit = np.eye(count)
        change = inertia_change(self._inertia_slopes, standing.equilibrium[azimuth, level])
        inverse = np.linalg.inv(unit + change)
        for slopes in (turning, damping):
            slopes[:, :count] = slopes[:, :count] @ inverse
        stiffness = np.square(self._root[:count, None])
        pressure = max(self._pressures[level], 1e-300)
        by_springs = stiffness * (unit - inverse) / pressure
        turning[:count, :count] += by_springs

    def _feeding(self, slopes: Floats, damping: Floats, most: float) -> Floats:
        """
        Find the part of slopes (m, m) [1/s^2] that adds more energy than damping (m,) [1/s] takes.

        The antisymmetric part of slopes adds energy to a sway of two coordinates, and damping
        takes energy from both. Without this bound, hanging twigs flutter in gales.
        """
        circulating = 0.5 * (slopes - slopes.T)
        dampers = np.maximum(damping, 1e-6 * self._root)
        scale = 1.0 / np.sqrt(dampers * self._root)
        scaled = circulating * scale * scale[:, None]
        if float(np.linalg.norm(scaled)) <= most:  # at least the spectral norm
            return np.zeros_like(slopes)
        ratio = float(np.linalg.norm(scaled, 2))
        return circulating * max(0.0, 1.0 - most / ratio)

    def _fill_aslant(self, table: dict[str, Any]) -> None:
        """Fill the change of slopes by oblique winds at rest, and slopes of steep winds."""
        azimuths = self._azimuths
        rising = [self._slopes(self._still, direction(a, _SLOPE_AT))[0] for a in azimuths]
        # A falling wind is the opposite of one that rises from the other side.
        falling = -np.roll(rising, len(azimuths) // 2, axis=0)
        risen = np.array(rising) - falling
        table['lean'] = _between(risen / (2.0 * np.sin(_SLOPE_AT)))
        turning, damping = self._slopes(self._still, direction(0.0, np.pi / 2.0))
        table['steep_turning'] = np.array([-turning, turning])
        steep = _without_gain(damping.astype(np.float64))
        table['steep_damping'] = np.array([steep, steep])


def fit_harmonics(at_rest: LoadsOfWinds) -> tuple[Floats, Floats]:
    """
    Fit the load at rest in all winds, horizontal ones with most weight.

    Returns harmonics, (h, m), and the largest loads, (m,), both at 1 kg/m/s^2.
    """
    elevation = np.repeat(_ELEVATIONS, len(_AZIMUTHS))
    azimuth = np.tile(_AZIMUTHS, len(_ELEVATIONS))
    directions = direction(azimuth, elevation)
    likeliness = np.exp(-0.5 * (elevation / _ELEVATION_SPREAD) ** 2) + 0.02
    likeliness[elevation > 0.0] *= 2.0  # the opposite wind has the opposite load
    solid_angle = np.maximum(np.cos(elevation), 1.0 / N_AZIMUTHS)
    weight = np.sqrt(likeliness)
    weight *= np.sqrt(solid_angle)
    loads = at_rest(directions)
    values = harmonics_at(directions) * weight[:, None]
    weighted = loads * weight[:, None]
    fitted = np.linalg.lstsq(values, weighted, rcond=None)[0]
    return np.asarray(fitted), np.abs(loads).max(axis=0)


def _rising_levels(equilibrium: Floats, amount: Floats) -> Floats:
    """Find the lean at each equilibrium, (a, l); it rises even for a tree without any load."""
    levels = np.einsum('ajm,am->aj', equilibrium, amount)
    largest = float(np.abs(levels).max()) or 1.0
    least = 1e-6 * largest * np.arange(N_LEVELS)
    return np.asarray(np.maximum.accumulate(levels, axis=1) + least)


def _between(values: Floats) -> Floats:
    """Interpolate values at every other azimuth, the first axis, to `N_AZIMUTHS`."""
    waves = np.fft.rfft(values, axis=0)
    waves[-1] *= 0.5
    return np.asarray(np.fft.irfft(waves, N_AZIMUTHS, axis=0) * (N_AZIMUTHS / len(values)))


def _without_gain(damping: Floats) -> Floats:
    """
    Take what adds energy to any motion off slopes of loads by rates, (..., m, m).

    Of the symmetric part, which alone does work, the positive eigenvalues are left out. Weighted
    means of such slopes, as of the corners around a wind and a lean, add no energy either.
    """
    work, axes = np.linalg.eigh(0.5 * (damping + np.swapaxes(damping, -1, -2)))
    gain = (axes * np.maximum(work, 0.0)[..., None, :]) @ np.swapaxes(axes, -1, -2)
    return np.asarray(damping - gain)
