"""
The table of the model `wind_basis`: what every even wind does to the modes of a tree.

In one even wind U = |U| d all branches feel one direction d, and the load is ``Q = s L(d)`` with the
dynamic pressure ``s = p(|U|) |U|^2``. L is a smooth function on the sphere, and so is each projection
of it on a mode (Diener, Rodriguez, Baboud & Reveret 2009, *Wind projection basis for real-time
animation of trees*, Computer Graphics Forum 28(2), 533-540). Here it is a sum of harmonics Y.

To it comes what the tree's own motion changes. A tree leans away from the wind, along the static
deflection e(d) for the most part, by an amount a (the dynamic pressure that would hold it there).
For azimuths of the wind and levels of a the table has the load there, its slope by the modes (the
load turns and leans with the tree) and by their rates (aerodynamic damping):

    F = s [Y C + load(a) + turning(a) (eta - a e) + d_z lean eta + (s - a) excess]
        + p |U| damping(a) eta'
    x = Phi eta + V s [Y R + rest(a)]

with V the few shapes that the static rest of the modes left out takes.

"""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np

from tree_sway_ros.core.arrays import Floats
from tree_sway_ros.core.kernel import fused
from tree_sway_ros.core.motion.drag import pressure
from tree_sway_ros.core.motion.fill_records import load_records
from tree_sway_ros.core.motion.harmonics import COUNT, fill_harmonics
from tree_sway_ros.core.motion.modal import ModalBank, wind_moments
from tree_sway_ros.core.motion.records import WORK

N_AZIMUTHS, N_LEVELS, N_REST = 24, 5, 12
"""Azimuths of the wind and levels of the lean in the table, and shapes of the static rest."""

SPEEDS = np.array([0.0, 7.0, 11.0, 16.0, 22.0])
"""Winds in [m/s] whose static deflections are the levels, for a tree that bears them."""

STEEPEST = np.sin(np.deg2rad(45.0))
"""Sine of the elevation up to which a wind is in the table."""

BEYOND = 1.6
"""Dynamic pressure up to which the table goes on, over that of the last level."""

_MODES_TOGETHER = 4
_LEAST_MODES = 12
_ELEVATIONS = np.deg2rad([-45.0, -30.0, -15.0, 0.0, 15.0, 30.0, 45.0])
_ELEVATION_SPREAD = 0.25
_SLOPE_AT = 0.35
_DIFFERENCE = 1e-3
_MOST_HELD = 0.01


@cache
def table_layout(n_modes: int, n_harmonics: int) -> np.dtype[np.void]:
    """
    Table of one tree; modes are filled up to a multiple of four, at least twelve.

    One layout serves most trees, so that the kernel is compiled once.

    """
    m = max(_LEAST_MODES, -(-n_modes // _MODES_TOGETHER) * _MODES_TOGETHER)
    a, n = N_AZIMUTHS, N_LEVELS
    return np.dtype(
        [
            ("n_modes", "i8"),
            ("degree", "i8"),
            ("levels", "f8", (n,)),  # dynamic pressures [kg/m/s^2]
            ("most_pressure", "f8"),  # up to which the table holds [kg/m/s^2]
            ("most_energy", "f8"),  # twice the strain energy up to which it holds [J]
            ("stiffness", "f8", (m,)),
            ("harmonics", "f8", (n_harmonics, m)),
            ("rest_harmonics", "f8", (n_harmonics, N_REST)),
            ("static", "f8", (a, m)),  # deflection per dynamic pressure
            ("amount", "f8", (a, m)),  # weights of the modes in the lean along it
            ("excess", "f8", (a, m)),
            ("lean", "f8", (a, m, m)),  # as the next ones: by the mode that moves, then the mode
            ("load", "f8", (a, n, m)),
            ("rest", "f8", (a, n, N_REST)),
            ("turning", "f8", (a, n, m, m)),
            ("damping", "f8", (a, n, m, m)),
            ("whole", "f8", (8, m)),  # columns of the propagator of a step
            ("half", "f8", (6, m)),  # of half a step under a constant load
        ]
    )


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
        Of `table_layout`, (1,); what depends on the time step is left 0.
    rest_shapes
        Key rotations of each shape of the static rest in [rad], (`N_REST`, N).
    error
        Share by which the static deflection of the tree, leaning as gusts have it, is told wrong.

    """

    def __init__(self, bank: ModalBank, drag_law: tuple[float, float], degree: int) -> None:
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
        loads, rests = self._fit_harmonics(table, degree)
        self._set_levels(table, drag_law)
        rest = self._fill_azimuths(table, degree, rests)
        self._fill_rest(table, rests, rest)
        self.error = self._tried(table, degree)

    def _moments(self, x: Floats, v: Floats, wind: Floats) -> Floats:
        """Moments of a wind of 1 kg/m^3 on a tree at x that moves at v, (N,)."""
        moments = np.empty(len(x))
        wind_moments(
            self._bank.branches, self._work, self._loads, x, v, moments, self._pull,
            float(wind[0]), float(wind[1]), float(wind[2]), 1.0,
        )  # fmt: skip
        return moments

    def _slopes(self, at: Floats, wind: Floats, ways: Floats, *, rates: bool = False) -> Floats:
        """Slope of the modal forces by each way (k, N) that the tree can bend or move, (k, m)."""
        slopes = np.zeros((len(ways), self._shapes.shape[1]))
        for row, way in zip(slopes, ways, strict=True):
            size = _DIFFERENCE / max(float(np.abs(way).max()), 1e-12)
            step = size * way
            if rates:
                gap = self._moments(at, step, wind) - self._moments(at, -step, wind)
            else:
                gap = self._moments(at + step, self._still, wind)
                gap -= self._moments(at - step, self._still, wind)
            row[:] = gap @ self._shapes / (2.0 * size)
        return slopes

    def _rest_of(self, moments: Floats) -> Floats:
        """Static rest of the modes left out under moments (k, N), (k, N)."""
        bank = self._bank
        rest: Floats = bank.flexibility * moments - (moments @ bank.held.T) @ self._shapes.T
        return rest

    def _fit_harmonics(self, table: Any, degree: int) -> tuple[Floats, Floats]:
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
        return fitted, self._rest_of(fitted)

    def _set_levels(self, table: Any, drag_law: tuple[float, float]) -> None:
        """Set the levels no higher than what the branches bear (`ModalBank.limit`)."""
        limit, share = self._bank.limit, 1.0
        at_rest = np.abs([self._moments(self._still, self._still, d) for d in _SIDES])
        while share > 0.05:
            top = share * SPEEDS[-1]
            moments = pressure(top, *drag_law) * top**2 * at_rest
            if np.maximum(moments - limit, 0.0).sum() <= _MOST_HELD * moments.sum():
                break
            share *= 0.8
        table["levels"] = [pressure(u, *drag_law) * u**2 for u in share * SPEEDS]
        table["most_pressure"] = BEYOND * table["levels"][-1]

    def _fill_azimuths(self, table: Any, degree: int, rests: Floats) -> Floats:
        """Fill loads and slopes by azimuth and level; return what they add to the rest."""
        m, shapes = int(table["n_modes"]), self._shapes
        stiffness = table["stiffness"][:m]
        rest = np.zeros((N_AZIMUTHS, N_LEVELS, len(shapes)))
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
            table["excess"][k, :m] = self._slopes(self._still, ahead, way[None])[0]
            for sign in (1.0, -1.0):
                slant = direction(azimuth, sign * _SLOPE_AT)
                slopes = self._slopes(self._still, slant, shapes.T)
                table["lean"][k, :m, :m] += sign * slopes / (2.0 * np.sin(_SLOPE_AT))
            upright = self._moments(self._still, self._still, ahead)
            for j, level in enumerate(table["levels"]):
                at = level * (shapes @ static + way)
                further = self._moments(at, self._still, ahead) - upright
                table["load"][k, j, :m] = further @ shapes
                rest[k, j] = self._rest_of(further[None])[0]
                table["turning"][k, j, :m, :m] = self._slopes(at, ahead, shapes.T)
                table["damping"][k, j, :m, :m] = self._slopes(at, ahead, shapes.T, rates=True)
        table["most_energy"] = 2.0 * energy
        return rest

    def _fill_rest(self, table: Any, rests: Floats, rest: Floats) -> None:
        """Lay the rest out on few shapes."""
        levels = table["levels"]
        whole = np.vstack([levels[-1] * rests, (levels[:, None] * rest).reshape(-1, rests.shape[1])])
        shapes = np.linalg.svd(whole, full_matrices=False)[2][:N_REST]
        self.rest_shapes = np.zeros((N_REST, rests.shape[1]))
        self.rest_shapes[: len(shapes)] = shapes
        table["rest_harmonics"] = rests @ self.rest_shapes.T
        table["rest"] = rest @ self.rest_shapes.T

    def _tried(self, table: Any, degree: int) -> float:
        """Try the table at leans and winds between those that it is made of."""
        from tree_sway_ros.core.motion.wind_basis import table_force

        rng = np.random.default_rng(7)
        m, stiffness = int(table["n_modes"]), table["stiffness"]
        forces, room = np.zeros(len(stiffness)), np.zeros((3, len(stiffness)))
        values, rest = np.zeros(COUNT[degree]), np.zeros(N_REST)
        wrong = right = 0.0
        for _ in range(_TRIALS):
            azimuth, elevation = rng.uniform(0.0, 2.0 * np.pi), rng.normal(0.0, 0.15)
            wind = direction(azimuth, elevation)
            push, lean = rng.uniform(0.05, 1.0, 2) * table["levels"][-2]
            side = direction(azimuth + rng.normal(0.0, 0.3), 0.0)
            at = harmonics_at(side[None], degree)[0]
            eta = np.zeros(len(stiffness))
            eta[:m] = lean * (at @ table["harmonics"][:, :m]) / stiffness[:m]
            table_force(
                self.record, wind[0], wind[1], wind[2], push, 0.0, eta, room[0],
                values, room, forces, rest,
            )  # fmt: skip
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


_SIDES = direction(0.25 * np.pi * np.arange(8), np.zeros(8))


def harmonics_at(directions: Floats, degree: int) -> Floats:
    """Harmonics of unit vectors (k, 3), (k, h)."""
    out = np.zeros((len(directions), COUNT[degree]))
    _fill(directions, degree, out)
    return out


@fused
def _fill(directions: Floats, degree: int, out: Floats) -> None:
    for i in range(len(directions)):
        fill_harmonics(directions[i, 0], directions[i, 1], directions[i, 2], degree, out[i])
