# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The state of a running scene as frames: its description, and its frames."""

from __future__ import annotations

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.leaves import leaf_clusters, LeafClusters
from tree_sway.core.scene import Simulator
from tree_sway.core.setup import is_in_leaf
from tree_sway.stream.check_description import Json
from tree_sway.stream.description import describe_scene
from tree_sway.stream.protocol import (
    decode_description,
    encode_state,
    PAUSED,
    RESTARTED,
    WIND_LOST,
)
from tree_sway.stream.scene_kind import scene_kinds, SceneKind
from tree_sway.stream.tables import tables_of

_FULLY_LEAVED = 4
"""Largest number of kinds that are described with the full number of clusters of leaves."""


class SceneState:
    """
    Writer of the state of a tree or a scene.

    Parameters
    ----------
    simulator
        The simulator of a tree or a scene.
    n_leaves
        Number of clusters of leaves to describe on each kind in leaf; fewer for more than
        `_FULLY_LEAVED` kinds.
    frame_id
        Frame of the poses.

    Raises
    ------
    FormatError
        A scene that is too large to describe, as in `check_description`.

    """

    def __init__(
        self,
        simulator: Simulator,
        n_leaves: int = 0,
        frame_id: str = 'map',
    ) -> None:
        self.simulator = simulator
        self.kinds = scene_kinds(simulator)
        self.names = simulator.names
        self._lay_out()
        count = _FULLY_LEAVED * n_leaves // max(_FULLY_LEAVED, len(self.kinds))
        self.leaves = [_leaves(kind, count) for kind in self.kinds]
        self.description = describe_scene(
            simulator.name, self.kinds, self.names, frame_id=frame_id, leaves=self.leaves
        )
        self._described = decode_description(self.description)
        self.identity = self._described.identity
        kinds = self._described.kinds
        trees = self._described.header['trees']
        self._matrices: list[Floats] = [kinds[tree['kind']]['basis_matrix'] for tree in trees]
        self._framed = -1, 0.0  # together, as they are read from another thread
        self._tables: bytes | None = None

    def tables(self) -> bytes | None:
        """Return the tables for a receiver, as `tables_of`; made at the first call."""
        if self._tables is None:
            self._tables = tables_of(self.simulator, self.kinds, self.identity)
        return self._tables

    def gusts(self) -> Json | None:
        """Return the gusts in the scene at the last frame, and its ``sequence``."""
        sequence, time = self._framed
        gusts = self.simulator.gusts
        return None if gusts is None else {'sequence': sequence, **gusts.recent(time)}

    def _lay_out(self) -> None:
        """Assign numbers to the coordinates of all trees, one tree after another."""
        sizes = np.zeros(len(self.names), dtype=np.int64)
        for kind in self.kinds:
            sizes[kind.numbers] = len(kind.basis.scale)
        first = np.cumsum([0, *sizes])
        self._rows = [
            first[kind.numbers][:, None] + np.arange(len(kind.basis.scale)) for kind in self.kinds
        ]
        self._sizes: list[int] = sizes.tolist()

    @property
    def coordinate_names(self) -> list[str]:
        """Return a name per coordinate: ``tree/c0``, or ``c0`` for a single tree."""
        is_alone = len(self.names) == 1
        return [
            f'c{i}' if is_alone else f'{name}/c{i}'
            for name, size in zip(self.names, self._sizes, strict=True)
            for i in range(size)
        ]

    def coordinates(self) -> Floats:
        """Present coordinates of all trees, (m,), and their ``beyond``, as in `Frame`."""
        whole = np.empty(sum(self._sizes))
        for kind, rows in zip(self.kinds, self._rows, strict=True):
            whole[rows] = kind.coordinates()
        parts = [whole]
        for number, touch in self.simulator.pushed.items():
            own = whole[sum(self._sizes[:number]) :][: self._sizes[number]]
            before = sum(map(len, self._matrices[:number])), 0.0
            parts += [(touch.beyond(self._matrices[number] @ own) + before).ravel()]
        return np.concatenate(parts)

    def frame(
        self,
        stamp: int,
        *,
        is_paused: bool = False,
        has_restarted: bool = False,
        is_wind_lost: bool = False,
    ) -> bytes:
        """
        Write the present state.

        Parameters
        ----------
        stamp
            Time of the state in [ns].
        is_paused
            True while time is paused.
        has_restarted
            True if the motion jumped since the frame before.
        is_wind_lost
            True while there is no measured wind.

        """
        flags = PAUSED * is_paused + RESTARTED * has_restarted + WIND_LOST * is_wind_lost
        sequence = self._framed[0] + 1
        gusts = self.simulator.gusts
        self._framed = sequence, 0.0 if gusts is None else gusts.time
        wind = self.simulator.wind
        coordinates = self.coordinates()
        return encode_state(self._described, sequence, stamp, wind, coordinates, flags)


def _leaves(kind: SceneKind, count: int) -> LeafClusters | None:
    """Clusters of leaves of a kind; None without leaves."""
    simulator = kind.simulator
    species = simulator.models[0].species
    if not count or not is_in_leaf(species, simulator.settings.in_leaf):
        return None
    rng = np.random.default_rng(0)
    return leaf_clusters(
        simulator.tree, rng, count=count, traits=species.leaves, look=species.look
    )
