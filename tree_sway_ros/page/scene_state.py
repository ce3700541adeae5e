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
    shape = np.round([*frames[:, 0, 2], *simulator.tree.length], 6).tobytes()
    like = found.get((simulator.model, shape))
    if like is not None:
        twin = _turned(like, frames, simulator.joints)
        if twin is not None:
            return twin
    runner = _runner(simulator)
    basis = state_basis(runner)
    if len(basis.scale) > MOST_COORDINATES:
        basis = state_basis(runner, MOST_COORDINATES)
    told = ToldBasis(basis.matrix, basis.projection, basis.scale, basis.error, frames)
    found[simulator.model, shape] = told
    return told


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
    c, s = np.cos(angle), np.sin(angle)
    with_it = basis.frames @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
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


def _runner(simulator: Any) -> SwaySimulator:
    """
    Make a simulator to find the basis on, so that the one that runs is left alone.

    It is of the same model, or of ``modes`` where that one has the same key rotations at less cost.

    """
    is_cheap = isinstance(simulator, SwaySimulator) and simulator.model != "coupled"
    model = simulator.model if is_cheap else "modes"
    settings = replace(simulator.settings, model=model, n_modes=None)
    return SwaySimulator(simulator.tree, simulator.species, settings)
