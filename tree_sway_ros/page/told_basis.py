# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The basis that a tree is told in: that of its model, shared by trees of one shape."""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from tree_sway_ros.core.arrays import Floats, Ints
from tree_sway_ros.core.motion.fill_records import turns_of_segments
from tree_sway_ros.core.scene.stand_member import StandMember
from tree_sway_ros.core.simulator.protocol import TreeSimulator
from tree_sway_ros.core.simulator.simulator import SwaySimulator
from tree_sway_ros.core.state.find_basis import state_basis
from tree_sway_ros.core.state.state_basis import BasisError

Records = NDArray[np.void]
ToldTree = TreeSimulator | StandMember
"""A tree whose state is told."""


@dataclass(frozen=True)
class ToldBasis:
    """
    The basis that a tree is told in.

    Parameters
    ----------
    matrix, scale, error
        As of `StateBasis`.
    projection
        Coordinates per unit of the solver's key rotations, (m, N).
    frames
        Chord, e1, e2 of each branch that receivers turn it about, (b, 3, 3).
    turns
        Vectors that tell what a unit of each further key rotation does, as receivers know it, (b,)
        of (3 m, k).
    from_own
        Those key rotations per unit of the solver's own, (b,) of (k, k).
    turn
        What rows of vectors of the solver's records are multiplied by to be those of the tree.

    """

    matrix: Floats
    projection: Floats
    scale: Floats
    error: BasisError
    frames: Floats
    turns: list[Floats]
    from_own: list[Floats]
    turn: Floats = field(default_factory=lambda: np.eye(3))

    def per_key(self, branch: int, turns: Floats) -> Floats:
        """Turn what is per unit of the solver's key rotations (k, 3) to those that are told."""
        return np.asarray(np.linalg.solve(self.from_own[branch].T, turns) @ self.turn)

    def coordinates(self, rotations: Floats) -> Floats:
        """Coordinates (m,) of the solver's key rotations (N,) in [rad]."""
        told: Floats = self.projection @ rotations
        return told


def told_basis(
    simulator: ToldTree, found: dict[Hashable, ToldBasis], *, is_running: bool = True
) -> ToldBasis:
    """
    Find the basis of a tree; trees of one shape and model share one, whichever way they are turned.

    Parameters
    ----------
    simulator
        Of the tree.
    found
        What was found for other trees, and is added to.
    is_running
        Whether the simulator is stepped meanwhile: then the basis is found on another one.

    """
    if isinstance(simulator, StandMember):
        kind = simulator.kind  # which stands still: the stand steps its table
        if id(kind) not in found:
            found[id(kind)] = _told(kind, *_axes(kind))
        return _yawed(found[id(kind)], simulator.yaw)
    frames, turns = _axes(simulator)
    shape = np.round([*frames[:, 0, 2], *simulator.tree.length], 6).tobytes()
    like = found.get((simulator.model, shape))
    if like is not None:
        twin = _turned(like, frames, turns, simulator.joints["coordinate"])
        if twin is not None:
            return twin
    told = _told(_runner(simulator, is_running), frames, turns)
    found[simulator.model, shape] = told
    return told


def _axes(simulator: TreeSimulator) -> tuple[Floats, list[Floats]]:
    """What the key rotations of each branch turn it about."""
    turns = [_further_turns(joint, simulator.bank.segments) for joint in simulator.joints]
    return simulator.joints["frame"], turns


def _told(runner: SwaySimulator, frames: Floats, turns: list[Floats]) -> ToldBasis:
    """Basis that a simulator finds, for a tree of these axes."""
    basis = state_basis(runner)
    same = [np.eye(2 + each.shape[1]) for each in turns]
    return ToldBasis(basis.matrix, basis.projection, basis.scale, basis.error, frames, turns, same)


def _yawed(basis: ToldBasis, yaw: float) -> ToldBasis:
    """The basis of a tree that is turned about the vertical, of whose kind the records are."""
    turn = _about_vertical(yaw)
    return replace(basis, frames=basis.frames @ turn, turn=turn)


def _about_vertical(angle: float) -> Floats:
    """Matrix that rows of vectors are multiplied by to be turned."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])


def _further_turns(joint: np.void, segments: Records) -> Floats:
    """Vectors that tell what a unit of each further key rotation of a branch does, (3 m, k)."""
    k = int(joint["n_coordinates"])
    rows = [*turns_of_segments(joint, segments), *(joint[n][:k] for n in ("reach", "push", "turn"))]
    return np.stack(rows)[:, 2:].transpose(0, 2, 1).reshape(3 * len(rows), -1)


def _turned(basis: ToldBasis, frames: Floats, turns: list[Floats], first: Ints) -> ToldBasis | None:
    """
    The basis of a tree that is the same but turned about the vertical; None if it is not.

    Each branch then has axes e1, e2 and further key rotations of its own choice. It is described by
    those of the first tree, turned with it, so that the matrix is the same; what the solver says is
    turned into them.

    """
    chord, other = basis.frames[:, 0], frames[:, 0]
    sine = (chord[:, 0] * other[:, 1] - chord[:, 1] * other[:, 0]).sum()
    angle = np.arctan2(sine, (chord[:, :2] * other[:, :2]).sum())
    turn = _about_vertical(float(angle))
    with_it = basis.frames @ turn
    if not np.allclose(with_it[:, 0], other, atol=1e-6):
        return None
    projection, from_own, told = basis.projection.copy(), [], []
    signs = np.array([[1.0], [-1.0]])
    for branch, own in enumerate(turns):
        vectors = basis.turns[branch].reshape(len(own) // 3, 3, own.shape[1])
        like = np.einsum("sak,ab->sbk", vectors, turn)
        told.append(like.reshape(own.shape))
        mix = np.eye(2 + own.shape[1])
        # Both say one rotation vector, x e2 - y e1.
        axes, own_axes = (signs * each[branch][[2, 1]] for each in (with_it, frames))
        mix[:2, :2] = axes @ own_axes.T
        if own.shape[1]:
            mix[2:, 2:], _, rank, _ = np.linalg.lstsq(told[-1], own, rcond=1e-4)
            fits = np.allclose(told[-1] @ mix[2:, 2:], own, atol=1e-3 * np.abs(own).max())
            if rank < own.shape[1] or not fits:
                return None
        keys = slice(first[branch], first[branch] + len(mix))
        projection[:, keys] = basis.projection[:, keys] @ mix
        from_own.append(mix)
    return ToldBasis(basis.matrix, projection, basis.scale, basis.error, with_it, told, from_own)


def _runner(simulator: TreeSimulator, is_running: bool) -> SwaySimulator:
    """
    Simulator to find the basis on: itself, unless it runs or another has the same key rotations at
    less cost.

    """
    is_cheap = isinstance(simulator, SwaySimulator) and simulator.model != "coupled"
    if isinstance(simulator, SwaySimulator) and is_cheap and not is_running:
        return simulator
    model = simulator.model if is_cheap else "modes"
    settings = replace(simulator.settings, model=model, n_modes=None)
    return SwaySimulator(simulator.tree, simulator.species, settings)
