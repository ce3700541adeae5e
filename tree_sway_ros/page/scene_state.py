"""
The state of a running scene as frames: what is described once, what is told of each moment.

"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from tree_sway_ros.core.leaves.foliage import LeafClusters
from tree_sway_ros.core.scene.make import simulators_of
from tree_sway_ros.core.simulator.simulator import SwaySimulator
from tree_sway_ros.core.state.find_basis import state_basis
from tree_sway_ros.page.description import describe_scene
from tree_sway_ros.page.protocol import (
    BEYOND_SCALE,
    PAUSED,
    RESTARTED,
    Frame,
    decode_description,
    encode_frame,
)

MOST_COORDINATES = 32
"""Of one tree: a frame then takes 92 bytes."""


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
        found: dict[Any, Any] = {}
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
            quantised, n_cut = basis.quantised(basis.coordinates(each.rotations()))
            steps.append(quantised)
            flags |= BEYOND_SCALE if n_cut else 0
        self._sequence += 1
        wind = self.simulator.wind
        whole = np.concatenate(steps)
        return encode_frame(Frame(self._short, self._sequence - 1, stamp, flags, wind, whole))

    def _names(self) -> list[str]:
        return list(getattr(self.simulator, "names", (self.simulator.tree.name,)))


def _basis(simulator: Any, found: dict[Any, Any]) -> Any:
    """
    Basis of a tree; trees of one shape and model share one, whichever way they are turned.

    """
    frames = simulator.joints["frame"]
    # Directions as the stem sees them are the same in a tree that is turned about.
    relative = np.round(frames @ frames[0].T, 6) + 0.0
    key = simulator.model, relative.tobytes(), np.round(simulator.tree.length, 6).tobytes()
    if key not in found:
        runner = _runner(simulator)
        basis = state_basis(runner)
        if len(basis.scale) > MOST_COORDINATES:
            basis = state_basis(runner, MOST_COORDINATES)
        found[key] = basis
    return found[key]


def _runner(simulator: Any) -> SwaySimulator:
    """
    Make a simulator to find the basis on, so that the one that runs is left alone.

    It is of the same model, or of ``modes`` where that one has the same key rotations at less cost.

    """
    is_cheap = isinstance(simulator, SwaySimulator) and simulator.model != "coupled"
    model = simulator.model if is_cheap else "modes"
    settings = replace(simulator.settings, model=model, n_modes=None)
    return SwaySimulator(simulator.tree, simulator.species, settings)
