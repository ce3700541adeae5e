# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Kinds of a scene for its description: trees on one table share geometry and basis.

A tree that is solved by itself is a separate kind.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.model.settings import USUAL
from tree_sway.core.model.state_basis import StateBasis
from tree_sway.core.run.find_basis import state_basis
from tree_sway.core.run.simulator import SharedTable, SwaySimulator
from tree_sway.core.scene.scene_simulator import Simulator
from tree_sway.core.setup.prepare import prepare

Place = tuple[float, float, float, float, float]
"""Place of a tree: x, y, z [m], rotation about the vertical [rad], scale."""


@dataclass(eq=False)
class SceneKind:
    """
    Trees with the same description.

    Parameters
    ----------
    simulator
        Simulator with their records.
    basis
        Basis of its state.
    coordinates
        Function that returns the present coordinates of its trees, (t, m).
    numbers, places
        Numbers of the trees in the scene, and their places.

    """

    simulator: SwaySimulator
    basis: StateBasis
    coordinates: Callable[[], Floats]
    numbers: list[int]
    places: list[Place]


def scene_kinds(simulator: Simulator, *, is_running: bool = True) -> list[SceneKind]:
    """
    Find the kinds of a scene, and their bases.

    Parameters
    ----------
    simulator
        The simulator of a tree or a scene.
    is_running
        True if it is stepped at the same time: then a basis is found on a copy.

    """
    kinds, places = [], simulator.places
    for shared in simulator.shared:
        # The scene steps its own records, but a change of tuning goes through the model.
        basis = state_basis(_runner(shared.simulator, is_running))
        per_shape = shared.bank.all_shapes @ basis.projection.T

        def found(shared: SharedTable = shared, per_shape: Floats = per_shape) -> Floats:
            return np.asarray(shared.coordinates() @ per_shape)

        where = [(x, y, z, yaw, scale) for x, y, z, yaw, scale in places[shared.numbers].tolist()]
        kinds.append(SceneKind(shared.simulator, basis, found, shared.numbers.tolist(), where))
    return kinds + [_alone(t, each, is_running) for t, each in simulator.own.items()]


def _alone(number: int, simulator: SwaySimulator, is_running: bool) -> SceneKind:
    """Return the kind of a single tree, described at its place."""
    basis = state_basis(_runner(simulator, is_running))
    x, y, z = simulator.tree.start[0].tolist()

    def found() -> Floats:
        return np.asarray(basis.projection @ simulator.banks[0].oscillators.rotations())[None]

    return SceneKind(simulator, basis, found, [number], [(x, y, z, 0.0, 1.0)])


def _runner(simulator: SwaySimulator, is_running: bool) -> SwaySimulator:
    """Choose the simulator for finding the basis: this one if at rest and as cheap."""
    is_cheap = simulator.model not in ('full', 'auto')
    if is_cheap and not is_running:
        return simulator
    if simulator.model != 'full':
        return SwaySimulator(simulator.models[0])
    made_of = simulator.tree, simulator.models[0].species, simulator.settings
    return SwaySimulator(prepare(*made_of, model=USUAL))
