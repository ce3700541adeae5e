# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The state of a running scene as frames: what is described once, what is told of each moment.

"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from tree_sway_ros.core.arrays import Floats
from tree_sway_ros.core.leaves.foliage import LeafClusters
from tree_sway_ros.core.motion.fill_records import turns_of_segments
from tree_sway_ros.core.scene.make import simulators_of
from tree_sway_ros.core.simulator.simulator import SwaySimulator
from tree_sway_ros.core.state.find_basis import state_basis
from tree_sway_ros.core.state.state_basis import BasisError
from tree_sway_ros.page.description import describe_scene
from tree_sway_ros.page.protocol import (
    BEYOND_SCALE,
    PAUSED,
    RESTARTED,
    Frame,
    decode_description,
    encode_frame,
    quantised,
)

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
    turns
        Vectors that tell what a unit of each further key rotation does, as receivers know it, (b,)
        of (3 m, k).
    from_own
        Those key rotations per unit of the solver's own, (b,) of (k, k).

    """

    matrix: Floats
    projection: Floats
    scale: Floats
    error: BasisError
    frames: Floats
    turns: list[Floats]
    from_own: list[Floats]

    def per_key(self, branch: int, turns: Floats) -> Floats:
        """Turn what is per unit of the solver's key rotations (k, 3) to those that are told."""
        return np.asarray(np.linalg.solve(self.from_own[branch].T, turns), dtype=np.float64)

    def coordinates(self, rotations: Floats) -> Floats:
        """Coordinates (m,) of the solver's key rotations (N,) in [rad]."""
        told: Floats = self.projection @ rotations
        return told


class SceneState:
    """
    Tells the state of a tree or a forest.

    Finding the basis takes some seconds; the simulator may run meanwhile.

    Parameters
    ----------
    simulator
        Of a tree or a forest.
    leaves
        Clusters that are drawn; None without.
    frame_id
        Frame of the poses.

    """

    def __init__(
        self, simulator: Any, leaves: LeafClusters | None = None, frame_id: str = "map"
    ) -> None:
        self.simulator = simulator
        self._parts = simulators_of(simulator)
        found: dict[Any, ToldBasis] = {}
        self.bases = [_basis(each, found) for each in self._parts]
        self.description = describe_scene(simulator, self.bases, frame_id=frame_id, leaves=leaves)
        described = decode_description(self.description)
        self.identity, self._short = described.identity, described.short_identity
        self._sequence = 0

    @property
    def coordinate_names(self) -> list[str]:
        """A name per coordinate: ``tree/c0``, or ``c0`` of a tree alone."""
        is_alone = len(self._parts) == 1
        return [
            f"c{i}" if is_alone else f"{name}/c{i}"
            for name, basis in zip(self._names(), self.bases, strict=True)
            for i in range(len(basis.scale))
        ]

    def coordinates(self) -> Any:
        """Coordinates of all trees now, (m,)."""
        return np.concatenate(
            [
                basis.coordinates(each.rotations())
                for each, basis in zip(self._parts, self.bases, strict=True)
            ]
        )

    def frame(self, stamp: int, *, is_paused: bool = False, has_restarted: bool = False) -> bytes:
        """
        Write the state of this moment.

        Parameters
        ----------
        stamp
            Its time in [ns].
        is_paused
            Whether time stands still.
        has_restarted
            Whether the motion jumped since the frame before.

        """
        steps, flags = [], PAUSED * is_paused + RESTARTED * has_restarted
        for each, basis in zip(self._parts, self.bases, strict=True):
            told, is_cut = quantised(basis.coordinates(each.rotations()), basis.scale)
            steps.append(told)
            flags |= BEYOND_SCALE if is_cut else 0
        self._sequence += 1
        wind = wind_of(self.simulator)
        whole = np.concatenate(steps)
        return encode_frame(Frame(self._short, self._sequence - 1, stamp, flags, wind, whole))

    def _names(self) -> list[str]:
        return list(getattr(self.simulator, "names", (self.simulator.tree.name,)))


def wind_of(simulator: Any) -> Floats:
    """Wind of the last step of any simulator in [m/s], (3,)."""
    wind: Floats = getattr(simulator, "shown", simulator).wind
    return wind


def _basis(simulator: Any, found: dict[Any, ToldBasis]) -> ToldBasis:
    """
    Basis of a tree; trees of one shape and model share one, whichever way they are turned.

    """
    frames = simulator.joints["frame"]
    turns = [_further_turns(joint, simulator.bank.segments) for joint in simulator.joints]
    shape = np.round([*frames[:, 0, 2], *simulator.tree.length], 6).tobytes()
    like = found.get((simulator.model, shape))
    if like is not None:
        twin = _turned(like, frames, turns, simulator.joints["coordinate"])
        if twin is not None:
            return twin
    runner = _runner(simulator)
    basis = state_basis(runner)
    if len(basis.scale) > MOST_COORDINATES:
        basis = state_basis(runner, MOST_COORDINATES)
    same = [np.eye(2 + each.shape[1]) for each in turns]
    told = ToldBasis(
        basis.matrix, basis.projection, basis.scale, basis.error, frames, turns, same
    )
    found[simulator.model, shape] = told
    return told


def _further_turns(joint: Any, segments: Any) -> Floats:
    """Vectors that tell what a unit of each further key rotation of a branch does, (3 m, k)."""
    k = int(joint["n_coordinates"])
    rows = [*turns_of_segments(joint, segments), *(joint[n][:k] for n in ("reach", "push", "turn"))]
    return np.stack(rows)[:, 2:].transpose(0, 2, 1).reshape(3 * len(rows), -1)


def _turned(
    basis: ToldBasis, frames: Floats, turns: list[Floats], first: Any
) -> ToldBasis | None:
    """
    The basis of a tree that is the same but turned about the vertical; None if it is not.

    Each branch then has axes e1, e2 and further key rotations of its own choice. It is described by
    those of the first tree, turned with it, so that the matrix is the same; what the solver says is
    turned into them.

    """
    chord, other = basis.frames[:, 0], frames[:, 0]
    sine = (chord[:, 0] * other[:, 1] - chord[:, 1] * other[:, 0]).sum()
    angle = np.arctan2(sine, (chord[:, :2] * other[:, :2]).sum())
    c, s = np.cos(angle), np.sin(angle)
    turn = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
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
    return ToldBasis(
        basis.matrix, projection, basis.scale, basis.error, with_it, told, from_own
    )


def _runner(simulator: Any) -> SwaySimulator:
    """
    Make a simulator to find the basis on, so that the one that runs is left alone.

    It is of the same model, or of ``modes`` where that one has the same key rotations at less cost.

    """
    is_cheap = isinstance(simulator, SwaySimulator) and simulator.model != "coupled"
    model = simulator.model if is_cheap else "modes"
    settings = replace(simulator.settings, model=model, n_modes=None)
    return SwaySimulator(simulator.tree, simulator.species, settings)
