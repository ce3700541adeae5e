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

from typing import Any

import numpy as np

from tree_sway_ros.core.arrays import Floats
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

SPEEDS = np.array([0.0, 7.0, 11.0, 16.0, 22.0])
"""
Winds in [m/s] whose static deflections are the levels; a share of them for a tree that bends so far
that the table would be wrong.

"""

STEEPEST = np.sin(np.deg2rad(45.0))
"""Sine of the elevation up to which a wind is in the table."""

BEYOND = 1.6
"""Dynamic pressure up to which the table goes on, over that of the last level."""

_ELEVATIONS = np.deg2rad([-45.0, -30.0, -15.0, 0.0, 15.0, 30.0, 45.0])
_ELEVATION_SPREAD = 0.25
_SLOPE_AT = 0.35
_REST_LEVEL = 1
_SWING = 0.3
_DIFFERENCE = 1e-3
_SHARES = (1.0, 0.7, 0.5, 0.35, 0.25, 0.17, 0.1)
_MOST_WRONG = 0.004


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

    def __init__(self, bank: ModalBank, drag_law: DragLaw, degree: int) -> None:
        """Ask the tree for its loads in all winds."""
        self._bank, self._shapes = bank, bank.shapes
        n, m = bank.shapes.shape
        self._work = np.zeros(len(bank.branches), dtype=WORK)
        self._loads, self._pull = load_records(bank.branches), np.zeros(len(bank.branches))
        self._still = np.zeros(n)
        self.record = np.zeros(1, dtype=table_layout(m, COUNT[degree]))
        table = self.record[0]
        table["n_modes"], table["degree"] = m, degree
        table["stiffness"] = 1.0
        table["stiffness"][:m] = bank.stiffness
        rests = self._fit_harmonics(table, degree)
        for share in _SHARES:
            self._set_levels(table, drag_law, share)
            self._fill_azimuths(table, degree, rests)
            self.error = self._tried(table, degree)
            if self.error <= _MOST_WRONG:
                break

    def _moments(self, x: Floats, v: Floats, wind: Floats) -> Floats:
        """Moments of a wind of 1 kg/m^3 on a tree at x that moves at v, (N,)."""
        moments = np.empty(len(x))
        wind_moments(
            self._bank.branches, self._work, self._loads, x, v, moments, self._pull,
            float(wind[0]), float(wind[1]), float(wind[2]), 1.0,
        )  # fmt: skip
        return moments

    def _slopes(self, at: Floats, wind: Floats, ways: Floats, *, rates: bool = False) -> Floats:
        """Slope of the moments by each way (k, N) that the tree can bend or move, (k, N)."""
        slopes = np.zeros_like(ways)
        for row, way in zip(slopes, ways, strict=True):
            size = _DIFFERENCE / max(float(np.abs(way).max()), 1e-12)
            step = size * way
            if rates:
                gap = self._moments(at, step, wind) - self._moments(at, -step, wind)
            else:
                gap = self._moments(at + step, self._still, wind)
                gap -= self._moments(at - step, self._still, wind)
            row[:] = gap / (2.0 * size)
        return slopes

    def _rest_of(self, moments: Floats) -> Floats:
        """Static rest of the modes left out under moments (k, N), (k, N)."""
        bank = self._bank
        rest: Floats = bank.flexibility * moments - (moments @ bank.held.T) @ self._shapes.T
        return rest

    def _fit_harmonics(self, table: Any, degree: int) -> Floats:
        """Fit the load at rest in winds of all azimuths, level ones to count for most."""
        elevation, azimuth = np.meshgrid(
            _ELEVATIONS, 2.0 * np.pi * np.arange(N_AZIMUTHS) / N_AZIMUTHS, indexing="ij"
        )
        directions = direction(azimuth.ravel(), elevation.ravel())
        weight = np.sqrt(np.exp(-0.5 * (elevation.ravel() / _ELEVATION_SPREAD) ** 2) + 0.02)
        loads = np.array([self._moments(self._still, self._still, d) for d in directions])
        values = harmonics_at(directions, degree) * weight[:, None]
        fitted = np.linalg.lstsq(values, loads * weight[:, None], rcond=None)[0]
        table["harmonics"][:, : table["n_modes"]] = fitted @ self._shapes
        return self._rest_of(fitted)

    def _set_levels(self, table: Any, drag_law: DragLaw, share: float) -> None:
        """Set the levels for a share of the usual winds, and how far the table goes on."""
        table["levels"] = [pressure(u, *drag_law) * u**2 for u in share * SPEEDS]
        table["most_pressure"] = BEYOND * table["levels"][-1]
        table["lean"], table["most_energy"] = 0.0, 0.0

    def _fill_azimuths(self, table: Any, degree: int, rests: Floats) -> None:
        """Fill loads and slopes by azimuth and level, then the rest."""
        m, shapes = int(table["n_modes"]), self._shapes
        stiffness = table["stiffness"][:m]
        rest = np.zeros((N_AZIMUTHS, N_LEVELS, len(shapes)))
        by_mode = np.zeros((2, N_AZIMUTHS, m, len(shapes)))
        energy = 0.0
        for k, azimuth in enumerate(2.0 * np.pi * np.arange(N_AZIMUTHS) / N_AZIMUTHS):
            ahead = direction(azimuth, 0.0)
            values = harmonics_at(ahead[None], degree)[0]
            static = values @ table["harmonics"][:, :m] / stiffness
            table["static"][k, :m] = static
            twice = float(static @ (stiffness * static))
            table["amount"][k, :m] = static * stiffness / twice if twice > 0.0 else 0.0
            energy = max(energy, twice * table["levels"][-1] ** 2)
            way = values @ rests
            table["excess"][k, :m] = self._slopes(self._still, ahead, way[None])[0] @ shapes
            for sign in (1.0, -1.0):
                slant = direction(azimuth, sign * _SLOPE_AT)
                slopes = self._slopes(self._still, slant, shapes.T)
                table["lean"][k, :m, :m] += sign * slopes @ shapes / (2.0 * np.sin(_SLOPE_AT))
            upright = self._moments(self._still, self._still, ahead)
            for j, level in enumerate(table["levels"]):
                at = level * (shapes @ static + way)
                further = self._moments(at, self._still, ahead) - upright
                table["load"][k, j, :m] = further @ shapes
                rest[k, j] = self._rest_of(further[None])[0]
                for kind, name in enumerate(("turning", "damping")):
                    slopes = self._slopes(at, ahead, shapes.T, rates=name == "damping")
                    table[name][k, j, :m, :m] = slopes @ shapes
                    if j == _REST_LEVEL:
                        by_mode[kind, k] = self._rest_of(slopes)
        table["most_energy"] = 2.0 * energy
        self._fill_rest(table, rests, rest, by_mode)

    def _fill_rest(self, table: Any, rests: Floats, rest: Floats, by_mode: Floats) -> None:
        """Lay the rest out on the few shapes that move the tips most in winds."""
        m, n, levels = int(table["n_modes"]), rests.shape[1], table["levels"]
        top = levels[_REST_LEVEL]
        moved = _SWING * top * np.abs(table["static"][:, :m]).max(axis=0)[:, None]
        pace = moved * np.sqrt(table["stiffness"][:m] / top)[:, None]
        parts = {
            "rest_harmonics": (rests, top),
            "rest": (rest, np.maximum(levels, levels[1])[:, None]),
            "rest_turning": (by_mode[0], top * moved),
            "rest_damping": (by_mode[1], top * pace),
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
            table[name][tuple(map(slice, amounts.shape))] = amounts
            first += rows

    def _tried(self, table: Any, degree: int) -> float:
        """Try the table at leans and winds between those that it is made of."""
        rng = np.random.default_rng(7)
        m, stiffness = int(table["n_modes"]), table["stiffness"]
        forces, room = np.zeros(len(stiffness)), np.zeros((3, len(stiffness)))
        values, rest, still = np.zeros(COUNT[degree]), np.zeros(N_REST), np.zeros(len(stiffness))
        wrong = right = 0.0
        for _ in range(_TRIALS):
            azimuth, elevation = rng.uniform(0.0, 2.0 * np.pi), rng.normal(0.0, 0.15)
            wind = direction(azimuth, elevation)
            push, lean = rng.uniform(0.05, 1.0, 2) * table["levels"][-2]
            side = direction(azimuth + rng.normal(0.0, 0.3), 0.0)
            at = harmonics_at(side[None], degree)[0]
            eta = np.zeros(len(stiffness))
            eta[:m] = lean * (at @ table["harmonics"][:, :m]) / stiffness[:m]
            _force(
                self.record, wind[0], wind[1], wind[2], push, eta, still, values, room, forces, rest
            )
            x = self._shapes @ eta[:m] + rest @ self.rest_shapes
            true = push * self._moments(x, self._still, wind) @ self._shapes
            wrong += float((np.square(forces[:m] - true) / stiffness[:m]).sum())
            right += float((np.square(true) / stiffness[:m]).sum())
        return float(np.sqrt(wrong / right)) if right > 0.0 else 0.0


_TRIALS = 200


def direction(azimuth: Any, elevation: Any) -> Floats:
    """Unit vectors, (..., 3)."""
    level = np.cos(elevation)
    out: Floats = np.stack(
        [level * np.cos(azimuth), level * np.sin(azimuth), np.sin(elevation) + 0.0 * azimuth],
        axis=-1,
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
    tables: Any, x: float, y: float, z: float, push: float, eta: Floats, rate: Floats,
    values: Floats, room: Floats, force: Floats, rest: Floats,
) -> None:  # fmt: skip
    wind_force(tables[0], x, y, z, push, 0.0, eta, rate, values, room, force)
    wind_rest(tables[0], x, y, push, 0.0, eta, rate, values, rest)
