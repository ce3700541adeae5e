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

from tree_sway.core.arrays import Floats, Ints
from tree_sway.core.model.state_basis import StateBasis
from tree_sway.core.run.simulator import SwaySimulator
from tree_sway.core.scene.scene_simulator import SceneSimulator, Simulator

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


def scene_kinds(simulator: Simulator) -> list[SceneKind]:
    """Return the kinds of the trees of a simulator, of one tree or of a scene."""
    if not isinstance(simulator, SceneSimulator):
        return [_alone(0, each) for each in simulator.simulators]
    kinds, trees = [], simulator.scene.trees
    for model, bank, numbers in simulator.shared:
        basis = model.basis
        per_shape = bank.all_shapes @ basis.projection.T

        def found(numbers: Ints = numbers, per_shape: Floats = per_shape) -> Floats:
            return np.asarray(simulator.shares(numbers) @ per_shape)

        where = [trees[number] for number in numbers.tolist()]
        places = [(tree.x, tree.y, tree.z, tree.yaw, tree.scale) for tree in where]
        kinds.append(SceneKind(model, basis, found, numbers.tolist(), places))
    return kinds + [_alone(t, each) for t, each in simulator.own.items()]


def _alone(number: int, simulator: SwaySimulator) -> SceneKind:
    """Return the kind of a single tree, described at its place."""
    basis = simulator.basis
    x, y, z = simulator.tree.start[0].tolist()

    def found() -> Floats:
        return np.asarray(basis.projection @ simulator.bank.oscillators.rotations())[None]

    return SceneKind(simulator, basis, found, [number], [(x, y, z, 0.0, 1.0)])
