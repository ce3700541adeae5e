# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The basis that a tree is told in: that of its model, shared by trees of one shape.

"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from tree_sway_ros.core.arrays import Floats
from tree_sway_ros.core.scene.stand_member import StandMember
from tree_sway_ros.core.simulator.protocol import TreeSimulator
from tree_sway_ros.core.simulator.simulator import SwaySimulator
from tree_sway_ros.core.state.find_basis import state_basis
from tree_sway_ros.core.state.state_basis import BasisError

ToldTree = TreeSimulator | StandMember
"""A tree whose state is told."""

MOST_COORDINATES = 32
"""Of one tree: a frame then takes 92 bytes."""


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

    """

    matrix: Floats
    projection: Floats
    scale: Floats
    error: BasisError
    frames: Floats

    def coordinates(self, rotations: Floats) -> Floats:
        """Coordinates (m,) of the solver's key rotations (N,) in [rad]."""
        told: Floats = self.projection @ rotations
        return told


def told_basis(
    simulator: ToldTree, found: dict[Any, ToldBasis], *, is_running: bool = True
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
            found[id(kind)] = _told(kind, kind.joints["frame"])
        return _yawed(found[id(kind)], simulator.yaw)
    frames = simulator.joints["frame"]
    shape = np.round([*frames[:, 0, 2], *simulator.tree.length], 6).tobytes()
    like = found.get((simulator.model, shape))
    if like is not None:
        twin = _turned(like, frames, simulator.joints)
        if twin is not None:
            return twin
    told = _told(_runner(simulator, is_running), frames)
    found[simulator.model, shape] = told
    return told


def _told(runner: SwaySimulator, frames: Floats) -> ToldBasis:
    """Basis that a simulator finds."""
    basis = state_basis(runner)
    if len(basis.scale) > MOST_COORDINATES:
        basis = state_basis(runner, MOST_COORDINATES)
    return ToldBasis(basis.matrix, basis.projection, basis.scale, basis.error, frames)


def _yawed(basis: ToldBasis, yaw: float) -> ToldBasis:
    """The basis of a tree that is turned about the vertical, frames and all."""
    c, s = np.cos(yaw), np.sin(yaw)
    turn = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
    return replace(basis, frames=basis.frames @ turn)


def _turned(basis: ToldBasis, frames: Floats, joints: Any) -> ToldBasis | None:
    """
    The basis of a tree that is the same but turned about the vertical; None if it is not.

    Each branch then turns about axes e1, e2 of its own choice. It is described by those of the
    first tree, turned with it, so that the matrix is the same; what the solver says is turned into
    them.

    """
    chord, other = basis.frames[:, 0], frames[:, 0]
    sine = (chord[:, 0] * other[:, 1] - chord[:, 1] * other[:, 0]).sum()
    angle = np.arctan2(sine, (chord[:, :2] * other[:, :2]).sum())
    with_it = _yawed(basis, angle).frames
    if not np.allclose(with_it[:, 0], other, atol=1e-6):
        return None
    projection = basis.projection.copy()
    # Both say one rotation vector, x e2 - y e1.
    e1, e2 = with_it[:, 1], with_it[:, 2]
    of = {
        (0, 0): (e2 * frames[:, 2]).sum(axis=1),
        (0, 1): -(e2 * frames[:, 1]).sum(axis=1),
        (1, 0): -(e1 * frames[:, 2]).sum(axis=1),
        (1, 1): (e1 * frames[:, 1]).sum(axis=1),
    }
    for branch, joint in enumerate(joints):
        for pair in range(joint["n_pairs"]):
            i = joint["coordinate"] + 2 * pair
            x, y = basis.projection[:, i], basis.projection[:, i + 1]
            projection[:, i] = of[0, 0][branch] * x + of[1, 0][branch] * y
            projection[:, i + 1] = of[0, 1][branch] * x + of[1, 1][branch] * y
    return ToldBasis(basis.matrix, projection, basis.scale, basis.error, with_it)


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
