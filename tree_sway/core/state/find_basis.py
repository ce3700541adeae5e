# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Finding the basis of a tree's shapes: singular values of what the tips do in seeded winds.

Four winds, calm to storm, turn once about the tree each; each run counts alike, whatever its
strength. What the basis leaves out is found by a run in another wind.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.core.arrays import Floats, Records
from tree_sway.core.motion.response import tip_motion
from tree_sway.core.reduction.one_thread import one_thread
from tree_sway.core.state.full_scale import MARGIN
from tree_sway.core.state.state_basis import BasisError, StateBasis
from tree_sway.core.state.tree_state import TreeState
from tree_sway.core.tree.tree import Tree
from tree_sway.core.wind.simulated.turbulence import simulate_turbulence
from tree_sway.errors import ParameterError

COUNTS = (16, 24, 32)
"""Numbers of coordinates that are tried where none is asked for."""

LEFT_OUT = 0.004
"""Share of the motion that may then be left out, root mean square of all segments."""

SPEEDS = (3.0, 9.0, 15.0, 22.0)
"""Mean winds in [m/s] of the runs that the basis is made from."""

TRIAL_SPEED = 18.0
"""Mean wind in [m/s] of the run, not seen before, that its error is found in."""

_DT, _STEPS, _EVERY, _RUN_IN = 1.0 / 60.0, 960, 4, 60


class Swaying(Protocol):
    """A simulator of one tree whose key rotations can be read and placed."""

    tree: Tree

    @property
    def joints(self) -> Records:
        """Return the records of `BRANCH` by which the key rotations are described, (b,)."""

    def step(self, wind_mean: ArrayLike, dt: float) -> int:
        """Advance one step of dt [s] in a wind [m/s]."""

    def rotations(self) -> Floats:
        """Key rotations in [rad], (N,)."""

    def place_rotations(self, rotations: Floats, out: Floats | None = None) -> Floats:
        """Place every segment by key rotations, (n, 7)."""

    def state(self) -> TreeState:
        """All that is carried from step to step."""

    def set_state(self, state: TreeState) -> None:
        """Go on from a state."""

    def reset(self) -> None:
        """Go back to rest."""


@one_thread()
def state_basis(
    simulator: Swaying, n_coordinates: int | None = None, *, seed: int = 1
) -> StateBasis:
    """
    Find the coordinates that hold a tree's shapes.

    Parameters
    ----------
    simulator
        The tree, on its model. It is run, and then set back to the state that it was in. Models
        that share their joints can share a basis: ``coupled`` and ``segments`` that of ``modes``,
        which is found in a second.
    n_coordinates
        How many to keep; the least of `COUNTS` that leaves out no more than `LEFT_OUT` if None.
    seed
        Of the winds.

    Returns
    -------
    StateBasis
        The same bits for the same simulator and seed.

    Raises
    ------
    ParameterError
        A number of coordinates below 1.

    """
    if n_coordinates is not None and n_coordinates < 1:
        raise ParameterError(
            f'{n_coordinates} coordinates', where='state_basis', cure='ask for 1 or more'
        )
    before = simulator.state()
    runs = [
        np.stack([*_run(simulator, speed, seed + k, _STEPS, _EVERY, turns=1.0)], axis=1)
        for k, speed in enumerate(SPEEDS)
    ]
    trial = list(_run(simulator, TRIAL_SPEED, seed + 97, _STEPS, _EVERY, turns=0.7))
    simulator.set_state(before)
    matrix, projection = _singular_shapes(simulator.joints, runs)
    greatest = np.maximum(
        np.abs(projection @ np.hstack(runs)).max(axis=1), np.finfo(np.float64).tiny
    )
    counts = COUNTS if n_coordinates is None else (n_coordinates,)
    for count in counts:
        kept = StateBasis(
            np.ascontiguousarray(matrix[:, :count]),
            projection[:count].copy(),
            MARGIN * greatest[:count],
            BasisError(*np.zeros(6)),
        )
        error = _error(simulator, kept, trial)
        if error.rms <= LEFT_OUT * error.motion_rms or count >= matrix.shape[1]:
            break
    return StateBasis(kept.matrix, kept.projection, kept.scale, error)


def _run(
    simulator: Swaying, speed: float, seed: int, steps: int, every: int, turns: float
) -> Iterator[Floats]:
    """Key rotations in a wind that turns about the tree a number of times."""
    rng = np.random.default_rng(seed)
    wind = simulate_turbulence(speed, rate=1.0 / _DT, duration=steps * _DT, rng=rng)
    bearing = 2.0 * np.pi * (turns * np.arange(steps) / steps + rng.uniform())
    cosine, sine = np.cos(bearing), np.sin(bearing)
    x, y, z = wind.T
    turned = np.stack([cosine * x - sine * y, sine * x + cosine * y, z], axis=1)
    simulator.reset()
    for number, each in enumerate(turned):
        simulator.step(each, _DT)
        if number >= _RUN_IN and number % every == 0:
            yield simulator.rotations().copy()


def _singular_shapes(joints: Records, runs: list[Floats]) -> tuple[Floats, Floats]:
    """Shapes by falling share in the motion of the tips, (N, m), and the way back, (m, N)."""
    shapes, projections = [], []
    for rotations in runs:
        tips = tip_motion(joints, rotations).reshape(-1, rotations.shape[1])
        size = max(float(np.linalg.norm(tips)), np.finfo(np.float64).tiny)
        shapes.append(rotations / size)
        projections.append(tips / size)
    moved = np.hstack(projections)
    squares, mixes = np.linalg.eigh(moved.T @ moved)
    kept = np.flatnonzero(squares > 1e-14 * squares[-1])[::-1]
    mixes = mixes[:, kept] / np.sqrt(np.maximum(squares[kept], np.finfo(np.float64).tiny))
    mixes *= np.sign(mixes[np.abs(mixes).argmax(axis=0), np.arange(len(kept))])
    tips = (moved @ mixes).reshape(len(joints), 3, -1)
    return np.hstack(shapes) @ mixes, tip_moments(joints, tips).T


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


def _error(simulator: Swaying, basis: StateBasis, trial: list[Floats]) -> BasisError:
    """Set segments placed through the basis against those of the model."""
    rest = simulator.place_rotations(np.zeros(len(basis.matrix))).copy()
    found = np.zeros((3, 2))
    placed, through = np.empty_like(rest), np.empty_like(rest)
    for rotations in trial:
        simulator.place_rotations(rotations, placed)
        coordinates = basis.coordinates(rotations)
        exact, _ = basis.quantised(coordinates)
        for row, given in ((0, coordinates), (1, basis.from_quantised(exact))):
            simulator.place_rotations(basis.rotations(given), through)
            _add_gap(found[row], through, placed)
        _add_gap(found[2], placed, rest)
    found[:, 0] = np.sqrt(found[:, 0] / (len(trial) * len(rest)))
    return BasisError(*found.ravel().tolist())


def _add_gap(found: Floats, poses: Floats, others: Floats) -> None:
    """Add the squares of the gaps between segments, and keep the greatest gap."""
    squares = np.square(poses[:, :3] - others[:, :3]).sum(axis=1)
    found[0] += squares.sum()
    found[1] = max(found[1], float(np.sqrt(squares.max())))
