# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Kinds of a scene for its description: trees on one table share geometry and basis.

A tree that is solved by itself is a separate kind.
"""

from __future__ import annotations

from dataclasses import dataclass

from tree_sway.core.model import StateBasis
from tree_sway.core.run import basis_of, Motion, SwaySimulator
from tree_sway.core.scene import Simulator

_Place = tuple[float, float, float, float, float]
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
    coordinates: Motion
    numbers: list[int]
    places: list[_Place]


def scene_kinds(simulator: Simulator) -> list[SceneKind]:
    """Return the kinds of the trees of a simulator, of one tree or of a scene."""
    kinds = []
    places = simulator.places
    for group in simulator.groups:
        basis = basis_of(group.simulator)
        where = [(x, y, z, yaw, scale) for x, y, z, yaw, scale in places[group.numbers].tolist()]
        coordinates = group.in_basis(basis)
        kinds.append(SceneKind(group.simulator, basis, coordinates, group.numbers.tolist(), where))
    return kinds
