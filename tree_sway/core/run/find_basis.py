# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Finding the basis of a tree's shapes: singular values of the motion of the tips in seeded winds.

Four winds, calm to storm, turn once about the tree each; all runs have the same weight. The error
of the basis is found by a run in another wind.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
import math

import numpy as np

from tree_sway.core.arrays import Floats, Records
from tree_sway.core.model.state_basis import MARGIN, StateBasis
from tree_sway.core.run.simulator import SwaySimulator
from tree_sway.core.setup.one_thread import one_thread
from tree_sway.core.setup.tree_motion import tip_motion
from tree_sway.core.wind.simulated.turbulence import simulate_turbulence

COUNTS = (16, 24, 32)
"""Numbers of coordinates that are tried."""

LEFT_OUT = 0.004
"""Largest share of the motion that is left out, root mean square of all segments."""

SPEEDS = (3.0, 9.0, 15.0, 22.0)
"""Mean winds in [m/s] of the runs for the basis."""

TRIAL_SPEED = 20.0
"""Mean wind in [m/s] of a further run for its error."""

_BETWEEN = 0.1
"""Motion between base and tip by a unit of a coordinate, over the length of its branch in [1]."""

_DT, _STEPS, _EVERY, _RUN_IN = 1.0 / 60.0, 960, 4, 60


@one_thread()
def state_basis(simulator: SwaySimulator) -> StateBasis:
    """
    Find coordinates for a tree's shapes: the smallest number of `COUNTS` that suffices.

    The simulator is run, and then set back to its state. The same simulator gives the same basis.
    """
    before = simulator.state()
    runs = [
        np.stack([*_run(simulator, speed, 1 + k, turns=1.0)], axis=1)
        for k, speed in enumerate(SPEEDS)
    ]
    trial = list(_run(simulator, TRIAL_SPEED, 98, turns=0.7))
    simulator.set_state(before)
    matrix, projection = _singular_shapes(simulator.banks[0].branches, runs)
    greatest = np.abs(projection @ np.hstack(runs)).max(axis=1)
    scale = MARGIN * np.maximum(greatest, np.finfo(np.float64).tiny)
    for count in COUNTS:
        shapes = np.ascontiguousarray(matrix[:, :count])
        basis = StateBasis(shapes, projection[:count].copy(), scale[:count].copy(), 0.0)
        left_out, error = _errors(simulator, basis, trial)
        if left_out <= LEFT_OUT:
            break
    return replace(basis, error=error)


def _run(simulator: SwaySimulator, speed: float, seed: int, turns: float) -> Iterator[Floats]:
    """Key rotations in a wind that turns about the tree a number of times."""
    rng = np.random.default_rng(seed)
    wind = simulate_turbulence(speed, rate=1.0 / _DT, duration=_STEPS * _DT, rng=rng)
    bearing = 2.0 * np.pi * (turns * np.arange(_STEPS) / _STEPS + rng.uniform())
    cosine, sine = np.cos(bearing), np.sin(bearing)
    x, y, z = wind.T
    turned = np.stack([cosine * x - sine * y, sine * x + cosine * y, z], axis=1)
    simulator.reset()
    for number, each in enumerate(turned):
        simulator.step(each, _DT)
        if number >= _RUN_IN and number % _EVERY == 0:
            yield simulator.rotations().copy()


def _singular_shapes(joints: Records, runs: list[Floats]) -> tuple[Floats, Floats]:
    """
    Shapes by decreasing share in the motion of the tips, (N, m), and their inverse, (m, N).

    The shapes between base and tip have a share by the rotations of each branch over its length.
    """
    shapes, projections = [], []
    length = np.linalg.norm(joints['tip'] - joints['base'], axis=1)
    between = _BETWEEN * np.repeat(length, joints['n_coordinates'])[:, None]
    for rotations in runs:
        tips = tip_motion(joints, rotations).reshape(-1, rotations.shape[1])
        size = max(float(np.linalg.norm(tips)), np.finfo(np.float64).tiny)
        shapes.append(rotations / size)
        projections.append(np.vstack([tips, between * rotations]) / size)
    moved = np.hstack(projections)
    squares, mixes = np.linalg.eigh(moved.T @ moved)
    chosen = np.flatnonzero(squares > 1e-14 * squares[-1])[::-1]
    mixes = mixes[:, chosen] / np.sqrt(np.maximum(squares[chosen], np.finfo(np.float64).tiny))
    mixes *= np.sign(mixes[np.abs(mixes).argmax(axis=0), np.arange(len(chosen))])
    moved = moved @ mixes
    tips = moved[: 3 * len(joints)].reshape(len(joints), 3, -1)
    moments = tip_moments(joints, tips) + between * moved[3 * len(joints) :]
    return np.hstack(shapes) @ mixes, moments.T


def tip_moments(joints: Records, forces: Floats) -> Floats:
    """Moments on coordinates (N, m) under forces on tips (b, 3, m): `tip_motion` transposed."""
    moments = np.zeros((int(joints['n_coordinates'].sum()), forces.shape[-1]))
    wrench = np.concatenate([forces, np.cross(joints['tip'][:, :, None], forces, axis=1)], axis=1)
    for b in range(len(joints) - 1, -1, -1):
        joint = joints[b]
        k, i = int(joint['n_coordinates']), int(joint['coordinate'])
        moments[i : i + k] += joint['tip_mode'][:k] @ forces[b]
        if joint['parent'] >= 0:
            parent = joints[joint['parent']]
            k, i = int(parent['n_coordinates']), int(parent['coordinate'])
            moments[i : i + k] += joint['twist'][:k] @ wrench[b]
            wrench[joint['parent']] += wrench[b]
    return moments


def _errors(
    simulator: SwaySimulator, basis: StateBasis, trial: list[Floats]
) -> tuple[float, float]:
    """Share of the motion outside of a basis, root mean square, and its error in [m]."""
    rest = simulator.place_rotations(np.zeros(len(basis.matrix)))[:, :3]
    left_out, motion, greatest = 0.0, np.finfo(np.float64).tiny, 0.0
    for rotations in trial:
        placed = simulator.place_rotations(rotations)[:, :3]
        coordinates = basis.coordinates(rotations)
        near, sent = (
            simulator.place_rotations(basis.rotations(each))[:, :3]
            for each in (coordinates, basis.rounded(coordinates))
        )
        left_out += float(np.square(near - placed).sum())
        motion += float(np.square(placed - rest).sum())
        greatest = max(greatest, float(np.linalg.norm(sent - placed, axis=1).max()))
    return math.sqrt(left_out / motion), greatest
