# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Kinds of a scene for its description: trees on one table share geometry and basis.

A tree that is solved by itself is a separate kind.
"""

from __future__ import annotations

from dataclasses import dataclass

from tree_sway.core.arrays import Floats
from tree_sway.core.model import StateBasis
from tree_sway.core.run import basis_of, Motion, SwaySimulator
from tree_sway.core.scene import Simulator


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
    numbers
        Numbers of the trees in the scene.
    places
        x, y, z [m], rotation about the vertical [rad] and scale of each, (t, 5).

    """

    simulator: SwaySimulator
    basis: StateBasis
    coordinates: Motion
    numbers: list[int]
    places: Floats


def scene_kinds(simulator: Simulator) -> list[SceneKind]:
    """Return the kinds of the trees of a simulator, of one tree or of a scene."""
    kinds = []
    places = simulator.places
    for group in simulator.groups:
        basis = basis_of(group.simulator)
        coordinates, own = group.in_basis(basis), places[group.numbers]
        numbers = group.numbers.tolist()
        kinds.append(SceneKind(group.simulator, basis, coordinates, numbers, own))
    return kinds
