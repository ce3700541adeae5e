# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The table of the model `wind_basis`: what every even wind does to the coordinates of a tree.

In one even wind U = |U| d all branches feel one direction d, and the load is ``Q = s L(d)`` with
the dynamic pressure ``s = p(|U|) |U|^2``. L is a smooth function on the sphere, and so is each
projection of it on a mode (Diener, Rodriguez, Baboud & Reveret 2009, *Wind projection basis for
real-time animation of trees*, Computer Graphics Forum 28(2), 533-540). Here it is a sum of
harmonics Y.

To it comes what the tree's own motion changes. In steady winds of an azimuth, calm to storm, a
tree is at rest in poses e, each further over than the one before; its lean, a mean of its
coordinates, says between which two of them it is. The table has the load there, its slope by the
coordinates (the load turns and leans with the tree) and by their rates (aerodynamic damping):

    F = s [Y C + load + turning (eta - e) + d_z lean eta] + p W damping eta'

with W the root mean square of wind and of what the branches move at. A steep wind goes over to
slopes of its own, those of winds straight up and down.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.core.arrays import Floats
from tree_sway.core.motion.drag import DragLaw, pressure
from tree_sway.core.motion.harmonics import COUNT, fill_harmonics
from tree_sway.core.motion.modal import ModalBank
from tree_sway.core.motion.records import N_AZIMUTHS, N_LEVELS, table_layout
from tree_sway.core.motion.static_answers import WindMoments

SPEEDS = (0.0, 3.0, 8.0, 13.0, 20.0, 36.0, 65.0)
"""Steady winds in [m/s] at the levels of the table."""

BEYOND = 1.1
"""Dynamic pressure up to which the table goes on, over that of the last of `SPEEDS`."""

_ELEVATIONS = np.deg2rad([-90.0, -60.0, -45.0, -30.0, -15.0, 0.0, 15.0, 30.0, 45.0, 60.0, 90.0])
_ELEVATION_SPREAD = 0.25
_SLOPE_AT = 0.35
_MOST_ENERGY = 3.0
_RAISES, _TURNS, _FARTHEST, _AT_REST = 4, 10, 0.3, 0.01

_LARGE = 2000
"""Branches of a tree above which fewer azimuths suffice."""


class WindBasisTable:
    """
    What an even wind does to a tree, found once.

    Parameters
    ----------
    bank
        The coordinates of the tree.
    wind_moments
        Loads of the tree.
    drag_law
        C and N of the species.
    degree
        Of the harmonics, 1, 3 or 5.

    Attributes
    ----------
    record
        Of `table_layout`, (1,).

    """

    @classmethod
    def of_arrays(cls, kept: Mapping[str, Any]) -> WindBasisTable:
        """Return the table whose `arrays` these are."""
        made = object.__new__(cls)
        made.record = kept['table']
        return made

    @property
    def arrays(self) -> dict[str, Any]:
        """All that it consists of."""
        return {'table': self.record}

    def __init__(
        self, bank: ModalBank, wind_moments: WindMoments, drag_law: DragLaw, degree: int
    ) -> None:
        """Find the loads of the tree in all winds."""
        self._shapes, self._loads = bank.shapes, wind_moments
        self._slopes = wind_moments.slopes(bank.shapes)
        n, m = bank.shapes.shape
        self._still = np.zeros(n)
        self.record = np.zeros(1, dtype=table_layout(m, COUNT[degree]))
        table = self.record[0]
        # Loads are found at some azimuths; those between follow, for loads are smooth there.
        each = 2 if len(wind_moments.branches) <= _LARGE else 3
        self._asked = 2.0 * np.pi * np.arange(0, N_AZIMUTHS, each) / N_AZIMUTHS
        table['n_modes'], table['degree'] = m, degree
        table['stiffness'] = 1.0
        table['stiffness'][:m] = bank.stiffness
        table['motion'][:m] = bank.mean_square_motion
        self._fit_harmonics(table, degree)
        pressures = [pressure(each, *drag_law) * each**2 for each in SPEEDS]
        self._fill_standing(table, pressures)
        self._fill_aslant(table)
        table['most_pressure'] = BEYOND * pressures[-1]
        energy = table['standing'][:, -1] ** 2 @ table['stiffness']
        table['most_energy'] = _MOST_ENERGY * float(energy.max())

    def _moments(self, x: Floats, v: Floats, wind: Floats) -> Floats:
        return self._loads(x, v, wind)

    def _fit_harmonics(self, table: np.void, degree: int) -> None:
        """Fit the load at rest in winds of all azimuths, level ones to count for most."""
        elevation, azimuth = np.meshgrid(
            _ELEVATIONS, 2.0 * np.pi * np.arange(N_AZIMUTHS) / N_AZIMUTHS, indexing='ij'
        )
        directions = direction(azimuth.ravel(), elevation.ravel())
        weight = np.sqrt(np.exp(-0.5 * (elevation.ravel() / _ELEVATION_SPREAD) ** 2) + 0.02)
        weight *= np.sqrt(np.maximum(np.cos(elevation.ravel()), 1.0 / N_AZIMUTHS))
        loads = [self._moments(self._still, self._still, d) @ self._shapes for d in directions]
        values = harmonics_at(directions, degree) * weight[:, None]
        fitted = np.linalg.lstsq(values, np.array(loads) * weight[:, None], rcond=None)[0]
        table['harmonics'][:, : table['n_modes']] = fitted

    def _fill_standing(self, table: np.void, pressures: list[float]) -> None:
        """Find the loads of the tree, and their slopes, where winds of each speed hold it."""
        shapes, m = self._shapes, int(table['n_modes'])
        stiffness = table['stiffness'][:m]
        shape = len(self._asked), N_LEVELS
        standing, load = np.zeros((2, *shape, m))
        amount = np.zeros((len(self._asked), m))
        turning, damping = np.zeros((2, *shape, m, m))
        for k, azimuth in enumerate(self._asked):
            ahead = direction(azimuth, 0.0)
            upright = self._moments(self._still, self._still, ahead) @ shapes
            amount[k] = upright / max(float(upright @ (upright / stiffness)), 1e-300)
            at = np.zeros(m)
            for j, push in enumerate(pressures):
                if j > 0:
                    at = self._held(at, pressures[j - 1], push, ahead, turning[k, j - 1])
                x = shapes @ at
                standing[k, j] = at
                load[k, j] = self._moments(x, self._still, ahead) @ shapes - upright
                turning[k, j], damping[k, j] = self._slopes(x, ahead)
        found = {'standing': standing, 'amount': amount, 'load': load}
        for name, values in found.items():
            table[name][..., :m] = _between(values)
        table['turning'][..., :m, :m] = _between(turning)
        table['damping'][..., :m, :m] = _between(damping)
        levels = np.einsum('ajm,am->aj', table['standing'], table['amount'])
        least = 1e-6 * np.abs(levels).max() * np.arange(N_LEVELS)
        table['levels'] = np.maximum.accumulate(levels, axis=1) + least

    def _held(
        self, at: Floats, push: float, further: float, ahead: Floats, turning: Floats
    ) -> Floats:
        """
        Find the coordinates (m,) of a tree at rest under a further dynamic pressure.

        From where a pressure ``push`` [kg/m/s^2] holds it on, by Broyden's method (Broyden 1965,
        Mathematics of Computation 19, 577-593) with the slopes there, as far as that leads.
        """
        root = np.sqrt(self.record[0]['stiffness'][: len(at)])

        def left(at: Floats, push: float) -> tuple[Floats, float]:
            load = push * (self._moments(self._shapes @ at, self._still, ahead) @ self._shapes)
            rest, whole = root * at - load / root, float(np.linalg.norm(load / root))
            return rest, float(np.linalg.norm(rest)) / max(whole, 1e-300)

        inverse = np.linalg.inv(np.eye(len(at)) - push * (turning / root / root[:, None]).T)
        for pushed in np.geomspace(max(push, further / 16.0), further, _RAISES + 1)[1:].tolist():
            here, (rest, size) = at, left(at, pushed)
            for _ in range(_TURNS):
                step = -inverse @ rest
                turn = float(np.abs(self._shapes @ (step / root)).max())
                step *= min(1.0, _FARTHEST / max(turn, 1e-12))
                then, less = left(here + step / root, pushed)
                if not less < 2.0 * size:
                    break
                change = inverse @ (then - rest)
                inverse += np.outer(step - change, step @ inverse) / float(step @ change)
                here, rest, size = here + step / root, then, less
                if size < _AT_REST:
                    break
            if not size < 4.0 * _AT_REST:
                break
            at = here
        return at

    def _fill_aslant(self, table: np.void) -> None:
        """Fill what winds aslant change in the slopes of an upright tree, and steep winds."""
        m, azimuths = int(table['n_modes']), self._asked
        rising = [self._slopes(self._still, direction(a, _SLOPE_AT))[0] for a in azimuths]
        # A falling wind is the opposite of one that rises from the other side.
        falling = -np.roll(rising, len(azimuths) // 2, axis=0)
        lean = (np.array(rising) - falling) / (2.0 * np.sin(_SLOPE_AT))
        table['lean'][:, :m, :m] = _between(lean)
        turning, damping = self._slopes(self._still, direction(0.0, np.pi / 2.0))
        table['steep_turning'][:, :m, :m] = -turning, turning
        table['steep_damping'][:, :m, :m] = damping


def _between(asked: Floats) -> Floats:
    """Values at `N_AZIMUTHS`, first axis, of a smooth function known at every other one."""
    waves = np.fft.rfft(asked, axis=0)
    waves[-1] *= 0.5
    found: Floats = np.fft.irfft(waves, N_AZIMUTHS, axis=0) * (N_AZIMUTHS / len(asked))
    return found


def direction(azimuth: ArrayLike, elevation: ArrayLike) -> Floats:
    """Return unit vectors, (..., 3)."""
    azimuth, elevation = np.broadcast_arrays(azimuth, elevation)
    level = np.cos(elevation)
    out: Floats = np.stack(
        [level * np.cos(azimuth), level * np.sin(azimuth), np.sin(elevation)], axis=-1
    )
    return out


def harmonics_at(directions: Floats, degree: int) -> Floats:
    """Harmonics of unit vectors (k, 3), (k, h)."""
    out = np.zeros((COUNT[degree], len(directions)))
    _fill_harmonics(*directions.T, degree, out)
    return out.T


_fill_harmonics = fill_harmonics.py_func  # type: ignore[attr-defined]  # whole arrays at once
