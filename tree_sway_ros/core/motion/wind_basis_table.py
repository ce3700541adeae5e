# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The table of the model `wind_basis`: what every even wind does to the modes of a tree.

In one even wind U = |U| d all branches feel one direction d, and the load is ``Q = s L(d)`` with
the dynamic pressure ``s = p(|U|) |U|^2``. L is a smooth function on the sphere, and so is each
projection of it on a mode (Diener, Rodriguez, Baboud & Reveret 2009, *Wind projection basis for
real-time animation of trees*, Computer Graphics Forum 28(2), 533-540). Here it is a sum of
harmonics Y.

To it comes what the tree's own motion changes. A tree leans away from the wind, along the static
deflection e(d) for the most part, by an amount a (the dynamic pressure that would hold it there).
For azimuths of the wind and levels of a the table has the load there, its slope by the modes (the
load turns and leans with the tree) and by their rates (aerodynamic damping):

    F = s [Y C + load(a) + turning(a) (eta - a e) + d_z lean eta + (s - a) excess]
        + p |U| damping(a) eta'
    x = Phi eta + V {s [Y R + rest(a) + turning_r (eta - a e)] + p |U| damping_r eta'}

with V the few shapes that the static rest of the modes left out takes.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from tree_sway_ros.core.arrays import Floats, Record, Records
from tree_sway_ros.core.kernel import fused
from tree_sway_ros.core.motion.drag import DragLaw, pressure
from tree_sway_ros.core.motion.fill_records import load_records
from tree_sway_ros.core.motion.harmonics import COUNT, fill_harmonics
from tree_sway_ros.core.motion.modal import ModalBank, wind_moments
from tree_sway_ros.core.motion.records import WORK
from tree_sway_ros.core.motion.response import tip_motion
from tree_sway_ros.core.motion.wind_basis_force import (
    N_AZIMUTHS,
    N_LEVELS,
    N_REST,
    table_layout,
    wind_force,
    wind_rest,
)

FASTEST = 22.0
"""
Wind in [m/s] whose static deflection is the last level; each level before it is that of half the
dynamic pressure of an even drag. A tree that bends so far that the table would be wrong has its
levels further down.

"""

STEEPEST = np.sin(np.deg2rad(45.0))
"""Sine of the elevation up to which a wind is in the table, unless it is gentle."""

GENTLE = 0.05
"""
Dynamic pressure, over that of the lowest lean, up to which a wind is in the table whatever its
elevation: some 1 m/s, as turbulence lets it blow straight up in a calm.

"""

BEYOND = 1.6
"""Dynamic pressure up to which the table goes on, over that of the last level."""

_ELEVATIONS = np.deg2rad([-45.0, -30.0, -15.0, 0.0, 15.0, 30.0, 45.0])
_ELEVATION_SPREAD = 0.25
_SLOPE_AT = 0.35
_SWING = 0.3
_DIFFERENCE = 1e-7
_LOWEST = 6
_MOST_WRONG = 0.007
_TRIALS = 200

_ASKED = 2.0 * np.pi * np.arange(0, N_AZIMUTHS, 2) / N_AZIMUTHS
"""Azimuths at which loads are found; those between follow, for loads are smooth in the azimuth."""


class _Level(NamedTuple):
    """What the wind does to a tree that leans along it, by azimuth."""

    pressure: float
    load: Floats
    rest: Floats
    turning: Floats
    damping: Floats
    rest_slopes: Floats | None


class WindBasisTable:
    """
    What an even wind does to a tree, found once.

    Parameters
    ----------
    bank
        The modes of the tree.
    drag_law
        C and N of the species.
    degree
        Of the harmonics, 1, 3 or 5.

    Attributes
    ----------
    record
        Of `table_layout`, (1,).
    rest_shapes
        Key rotations of each shape of the static rest in [rad], (`N_REST`, N).
    error
        Share by which the static deflection of the tree, leaning as gusts have it, is told wrong.

    """

    @classmethod
    def of_arrays(cls, kept: Mapping[str, Any]) -> WindBasisTable:
        """Return the table whose `arrays` these are."""
        made = object.__new__(cls)
        made.record, made.rest_shapes = kept['table'], kept['rest_shapes']
        made.error = float(kept['table_error'])
        return made

    @property
    def arrays(self) -> dict[str, Any]:
        """All that it consists of."""
        error = np.array(self.error)
        return {'table': self.record, 'rest_shapes': self.rest_shapes, 'table_error': error}

    def __init__(self, bank: ModalBank, drag_law: DragLaw, degree: int) -> None:
        """Ask the tree for its loads in all winds."""
        self._bank, self._shapes = bank, bank.shapes
        n, m = bank.shapes.shape
        self._work = np.zeros(len(bank.branches), dtype=WORK)
        self._loads = load_records(bank.branches)
        self._still = np.zeros(n)
        self.record = np.zeros(1, dtype=table_layout(m, COUNT[degree]))
        table = self.record[0]
        table['n_modes'], table['degree'] = m, degree
        table['stiffness'] = 1.0
        table['stiffness'][:m] = bank.stiffness
        self._along = harmonics_at(direction(_ASKED, 0.0), degree)
        self._rests = self._fit_harmonics(table, degree)
        self._fill_slopes(table)
        levels = [self._level(0.0)]
        levels += [self._level(_pressure(k, drag_law), lowest=k == 3) for k in (3, 2, 1, 0)]
        for lowest in range(N_LEVELS - 1, N_LEVELS + _LOWEST):
            self._fill_levels(table, levels)
            self.error = self._tried(table, degree)
            if self.error <= _MOST_WRONG:
                break
            below = self._level(_pressure(lowest, drag_law), lowest=True)
            levels = [levels[0], below, levels[1]._replace(rest_slopes=None), *levels[2:-1]]

    def _moments(self, x: Floats, v: Floats, wind: Floats) -> Floats:
        """Moments of a wind of 1 kg/m^3 on a tree at x that moves at v, (N,)."""
        moments = np.empty(len(x))
        wind_moments(
            self._bank.branches, self._work, self._loads, x, v, moments,
            float(wind[0]), float(wind[1]), float(wind[2]), 1.0,
        )  # fmt: skip
        return moments

    def _slopes(self, at: Floats, wind: Floats, shapes: Floats, *, rates: bool = False) -> Floats:
        """Slope of the moments by shapes (k, N) that the tree is bent by, or moves by, (k, N)."""
        slopes, here = np.zeros_like(shapes), self._moments(at, self._still, wind)
        for row, shape in zip(slopes, shapes, strict=True):
            size = _DIFFERENCE / max(float(np.abs(shape).max()), 1e-12)
            x, v = (at, size * shape) if rates else (at + size * shape, self._still)
            row[:] = (self._moments(x, v, wind) - here) / size
        return slopes

    def _rest_of(self, moments: Floats) -> Floats:
        """Return the static rest of the modes left out under moments (k, N), (k, N)."""
        bank = self._bank
        rest: Floats = bank.flexibility * moments - (moments @ bank.held.T) @ self._shapes.T
        return rest

    def _fit_harmonics(self, table: Record, degree: int) -> Floats:
        """Fit the load at rest in winds of all azimuths, level ones to count for most."""
        elevation, azimuth = np.meshgrid(
            _ELEVATIONS, 2.0 * np.pi * np.arange(N_AZIMUTHS) / N_AZIMUTHS, indexing='ij'
        )
        directions = direction(azimuth.ravel(), elevation.ravel())
        weight = np.sqrt(np.exp(-0.5 * (elevation.ravel() / _ELEVATION_SPREAD) ** 2) + 0.02)
        loads = np.array([self._moments(self._still, self._still, d) for d in directions])
        values = harmonics_at(directions, degree) * weight[:, None]
        fitted = np.linalg.lstsq(values, loads * weight[:, None], rcond=None)[0]
        table['harmonics'][:, : table['n_modes']] = fitted @ self._shapes
        return self._rest_of(fitted)

    def _fill_slopes(self, table: Record) -> None:
        """Fill the deflections in level winds, and what winds aslant and stronger ones change."""
        m, shapes = int(table['n_modes']), self._shapes
        stiffness = table['stiffness'][:m]
        azimuths = 2.0 * np.pi * np.arange(N_AZIMUTHS) / N_AZIMUTHS
        along = harmonics_at(direction(azimuths, 0.0), int(table['degree']))
        static = along @ table['harmonics'][:, :m] / stiffness
        twice = (static**2 @ stiffness)[:, None]
        table['static'][:, :m] = static
        table['amount'][:, :m] = static * stiffness / np.where(twice > 0.0, twice, 1.0)
        self._twice = float(twice.max())
        excess, lean = np.zeros((len(_ASKED), m)), np.zeros((len(_ASKED), m, m))
        for k, azimuth in enumerate(_ASKED):
            lean_shape = (self._along[k] @ self._rests)[None]
            excess[k] = self._slopes(self._still, direction(azimuth, 0.0), lean_shape)[0] @ shapes
            for sign in (1.0, -1.0):
                slant = direction(azimuth, sign * _SLOPE_AT)
                slopes = self._slopes(self._still, slant, shapes.T)
                lean[k] += sign * slopes @ shapes / (2.0 * np.sin(_SLOPE_AT))
        table['excess'][:, :m] = _between(excess)
        table['lean'][:, :m, :m] = _between(lean)

    def _level(self, pressure: float, *, lowest: bool = False) -> _Level:
        """
        Ask the tree for its loads where it leans as a dynamic pressure [kg/m/s^2] holds it.

        The slopes of the rest are large, and wanted of the lowest lean alone.
        """
        shapes, count = self._shapes, len(_ASKED)
        n, m = shapes.shape
        level = _Level(
            pressure, np.zeros((count, m)), np.zeros((count, n)), np.zeros((count, m, m)),
            np.zeros((count, m, m)), np.zeros((2, count, m, n)) if lowest else None,
        )  # fmt: skip
        for k, azimuth in enumerate(_ASKED):
            ahead = direction(azimuth, 0.0)
            static = self.record[0]['static'][2 * k, :m]
            at = pressure * (shapes @ static + self._along[k] @ self._rests)
            upright = self._moments(self._still, self._still, ahead)
            further = self._moments(at, self._still, ahead) - upright
            level.load[k] = further @ shapes
            level.rest[k] = self._rest_of(further[None])[0]
            for kind, into in enumerate((level.turning, level.damping)):
                slopes = self._slopes(at, ahead, shapes.T, rates=kind == 1)
                into[k] = slopes @ shapes
                if level.rest_slopes is not None:
                    level.rest_slopes[kind, k] = self._rest_of(slopes)
        return level

    def _fill_levels(self, table: Record, levels: list[_Level]) -> None:
        """Fill what the lean changes, and how far the table goes on."""
        m = int(table['n_modes'])
        table['levels'] = [level.pressure for level in levels]
        table['most_pressure'] = BEYOND * table['levels'][-1]
        table['most_energy'] = 2.0 * self._twice * table['levels'][-1] ** 2
        for j, level in enumerate(levels):
            table['load'][:, j, :m] = _between(level.load)
            table['turning'][:, j, :m, :m] = _between(level.turning)
            table['damping'][:, j, :m, :m] = _between(level.damping)
        rest = np.stack([level.rest for level in levels], axis=1)
        assert levels[1].rest_slopes is not None
        self._fill_rest(table, rest, levels[1].rest_slopes)

    def _fill_rest(self, table: Record, rest: Floats, by_mode: Floats) -> None:
        """Lay the rest out on the few shapes that move the tips most in winds."""
        m, levels, rests = int(table['n_modes']), table['levels'], self._rests
        n, top = rests.shape[1], levels[1]
        moved = _SWING * top * np.abs(table['static'][:, :m]).max(axis=0)[:, None]
        pace = moved * np.sqrt(table['stiffness'][:m] / top)[:, None]
        parts = {
            'rest_harmonics': (rests, top),
            'rest': (rest, np.maximum(levels, top)[:, None]),
            'rest_turning': (by_mode[0], top * moved),
            'rest_damping': (by_mode[1], top * pace),
        }
        told = np.concatenate([(part * size).reshape(-1, n) for part, size in parts.values()])
        tips = tip_motion(self._bank.branches, told.T).reshape(-1, len(told))
        squares, mixes = np.linalg.eigh(tips.T @ tips)
        kept = [i for i in np.argsort(-squares)[:N_REST] if squares[i] > 1e-12 * squares[-1]]
        share = np.zeros((len(told), N_REST))
        share[:, : len(kept)] = mixes[:, kept] * np.sqrt(squares[kept])
        self.rest_shapes = np.zeros((N_REST, n))
        self.rest_shapes[: len(kept)] = mixes[:, kept].T @ told / np.sqrt(squares[kept])[:, None]
        first = 0
        for name, (part, size) in parts.items():
            rows = part.size // n
            amounts = share[first : first + rows].reshape(*part.shape[:-1], N_REST) / size
            amounts = amounts if name == 'rest_harmonics' else _between(amounts)
            table[name][tuple(map(slice, amounts.shape))] = amounts
            first += rows

    def _tried(self, table: Record, degree: int) -> float:
        """Try the table at leans and winds between those that it is made of."""
        rng = np.random.default_rng(7)
        m, stiffness = int(table['n_modes']), table['stiffness']
        forces, scratch = np.zeros(len(stiffness)), np.zeros((3, len(stiffness)))
        values, rest, still = np.zeros(COUNT[degree]), np.zeros(N_REST), np.zeros(len(stiffness))
        wrong = right = 0.0
        for _ in range(_TRIALS):
            azimuth, elevation = rng.uniform(0.0, 2.0 * np.pi), rng.normal(0.0, 0.15)
            wind = direction(azimuth, elevation)
            push, lean = rng.uniform(0.05, 1.0, 2) * table['levels'][-1]
            side = direction(azimuth + rng.normal(0.0, 0.3), 0.0)
            at = harmonics_at(side[None], degree)[0]
            eta = np.zeros(len(stiffness))
            eta[:m] = lean * (at @ table['harmonics'][:, :m]) / stiffness[:m]
            _force(
                self.record, wind[0], wind[1], wind[2], push, eta, still, values, scratch, forces,
                rest,
            )  # fmt: skip
            x = self._shapes @ eta[:m] + rest @ self.rest_shapes
            true = push * self._moments(x, self._still, wind) @ self._shapes
            wrong += float((np.square(forces[:m] - true) / stiffness[:m]).sum())
            right += float((np.square(true) / stiffness[:m]).sum())
        return float(np.sqrt(wrong / right)) if right > 0.0 else 0.0


def _pressure(number: int, drag_law: DragLaw) -> float:
    """Dynamic pressure of a level in [kg/m/s^2], the last one's number being 0."""
    speed = FASTEST * 0.5 ** (0.5 * number)
    return pressure(speed, *drag_law) * speed**2


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
    out = np.zeros((len(directions), COUNT[degree]))
    _fill(directions, degree, out)
    return out


@fused
def _fill(directions: Floats, degree: int, out: Floats) -> None:
    for i in range(len(directions)):
        fill_harmonics(directions[i, 0], directions[i, 1], directions[i, 2], degree, out[i])


@fused
def _force(
    tables: Records, x: float, y: float, z: float, push: float, eta: Floats, rate: Floats,
    values: Floats, scratch: Floats, force: Floats, rest: Floats,
) -> None:  # fmt: skip
    wind_force(tables[0], x, y, z, push, 0.0, eta, rate, values, scratch, force)
    wind_rest(tables[0], x, y, push, 0.0, eta, rate, values, rest)
