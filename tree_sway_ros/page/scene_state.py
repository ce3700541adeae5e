# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The state of a running scene as frames: what is described once, what is told of each moment."""

from __future__ import annotations

from collections.abc import Hashable

import numpy as np

from tree_sway_ros.core.arrays import Floats
from tree_sway_ros.core.leaves.foliage import LeafClusters
from tree_sway_ros.core.scene.make import simulators_of
from tree_sway_ros.core.scene.stand import Stand
from tree_sway_ros.core.simulator.protocol import Simulator
from tree_sway_ros.errors import ParameterError
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
from tree_sway_ros.page.told_basis import ToldBasis, ToldTree, told_basis

MOST_SEGMENTS = 300_000
"""Of a scene that is described: some 20 MB, once."""


class SceneState:
    """
    Tells the state of a tree or a forest.

    Finding the basis takes some seconds; the simulator may run meanwhile.

    Parameters
    ----------
    simulator
        Of a tree, a forest or a stand.
    leaves
        Clusters that are drawn; None without.
    frame_id
        Frame of the poses.
    is_running
        Whether the simulator is stepped meanwhile; one that is not is itself run, and set back.

    Raises
    ------
    ParameterError
        More than `MOST_SEGMENTS`.

    """

    def __init__(
        self,
        simulator: Simulator,
        leaves: LeafClusters | None = None,
        frame_id: str = "map",
        *,
        is_running: bool = True,
    ) -> None:
        self.simulator = simulator
        if simulator.tree.n_segments > MOST_SEGMENTS:
            raise ParameterError(
                f"a state of {simulator.tree.n_segments} segments",
                where=simulator.tree.name,
                cure=f"tell of up to {MOST_SEGMENTS}, and of more by their poses",
            )
        self._parts: tuple[ToldTree, ...] = (
            simulator.members() if isinstance(simulator, Stand) else simulators_of(simulator)
        )
        found: dict[Hashable, ToldBasis] = {}
        self.bases = [told_basis(each, found, is_running=is_running) for each in self._parts]
        self.description = describe_scene(
            simulator, self._parts, self.bases, frame_id=frame_id, leaves=leaves
        )
        described = decode_description(self.description)
        self.identity, self._short = described.identity, described.short_identity
        self._sequence = 0

    @property
    def coordinate_names(self) -> list[str]:
        """A name per coordinate: ``tree/c0``, or ``c0`` of a tree alone."""
        is_alone = len(self._parts) == 1
        return [
            f"c{i}" if is_alone else f"{each.tree.name}/c{i}"
            for each, basis in zip(self._parts, self.bases, strict=True)
            for i in range(len(basis.scale))
        ]

    def coordinates(self) -> Floats:
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
        whole, wind = np.concatenate(steps), self.simulator.wind
        return encode_frame(Frame(self._short, self._sequence - 1, stamp, flags, wind, whole))
