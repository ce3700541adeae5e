# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The kinds of a scene as they are told: trees of one shape share geometry and basis.

A stand says which trees are of a kind. Of other scenes those are that are the same but for where
they stand and how they are turned; a tree that is like no other is a kind of its own.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from tree_sway_ros.core.arrays import Floats, Ints
from tree_sway_ros.core.motion.fill_records import turns_of_segments
from tree_sway_ros.core.scene.make import simulators_of
from tree_sway_ros.core.scene.stand import Stand
from tree_sway_ros.core.simulator.protocol import Simulator, TreeSimulator
from tree_sway_ros.core.simulator.simulator import SwaySimulator
from tree_sway_ros.core.state.find_basis import state_basis
from tree_sway_ros.core.state.state_basis import StateBasis

Place = tuple[float, float, float, float, float]
"""Of a tree: x, y, z [m], how far it is turned about the vertical [rad], its scale."""


@dataclass(eq=False)
class ToldKind:
    """
    Trees that are described once.

    Parameters
    ----------
    simulator
        Whose records they are described by.
    basis
        Of its state.
    coordinates
        Called for the coordinates of its trees now, (t, m).
    numbers, places
        Which trees of the scene they are, and where they stand.

    """

    simulator: TreeSimulator
    basis: StateBasis
    coordinates: Callable[[], Floats]
    numbers: list[int] = field(default_factory=list)
    places: list[Place] = field(default_factory=list)


def told_kinds(simulator: Simulator, *, is_running: bool = True) -> list[ToldKind]:
    """
    Find the kinds of a scene, and their bases.

    Parameters
    ----------
    simulator
        Of a tree, a forest or a stand.
    is_running
        Whether it is stepped meanwhile: then a basis is found on another simulator.

    """
    if not isinstance(simulator, Stand):
        return _kinds_of(dict(enumerate(simulators_of(simulator))), is_running)
    kinds = []
    for model, numbers in simulator.shared:
        # The model stands still: the stand steps its table.
        basis = state_basis(model)
        per_shape = model.bank.oscillators.all_shapes @ basis.projection.T
        kind = ToldKind(model, basis, partial(_shared, simulator, numbers, per_shape))
        kind.numbers = numbers.tolist()
        trees = [simulator.trees[number] for number in kind.numbers]
        kind.places = [(tree.x, tree.y, tree.z, tree.yaw, tree.scale) for tree in trees]
        kinds.append(kind)
    return kinds + _kinds_of(simulator.own, is_running)


def _kinds_of(simulators: dict[int, TreeSimulator], is_running: bool) -> list[ToldKind]:
    """Kinds of trees that are solved each on its own, by their numbers."""
    kinds: dict[Hashable, ToldKind] = {}
    ways: dict[Hashable, list[tuple[Floats, TreeSimulator]]] = {}
    for number, simulator in simulators.items():
        key: Hashable = simulator.model, _shape(simulator)
        twin = _turned(kinds[key], simulator) if key in kinds else None
        if twin is None:
            key = key if key not in kinds else number
            basis = state_basis(_runner(simulator, is_running))
            ways[key] = []
            kinds[key] = ToldKind(simulator, basis, partial(_coordinates, ways[key]))
            twin = 0.0, basis.projection
        ways[key].append((twin[1], simulator))
        kinds[key].numbers.append(number)
        x, y, z = simulator.tree.start[0].tolist()
        kinds[key].places.append((x, y, z, twin[0], 1.0))
    return list(kinds.values())


def _shared(stand: Stand, numbers: Ints, per_shape: Floats) -> Floats:
    """Coordinates of the trees of a stand that share a table."""
    coordinates: Floats = stand.shares(numbers) @ per_shape
    return coordinates


def _coordinates(ways: list[tuple[Floats, TreeSimulator]]) -> Floats:
    """Coordinates of trees, of which each has a way from its own key rotations to them."""
    return np.stack([projection @ simulator.rotations() for projection, simulator in ways])


def _shape(simulator: TreeSimulator) -> bytes:
    """Return what is the same of trees turned about the vertical, to a micrometre."""
    tree, chord = simulator.tree, simulator.joints['frame'][:, 0, 2]
    return np.round([*chord, *tree.length, *tree.base_diameter, *tree.tip_diameter], 6).tobytes()


def _turned(kind: ToldKind, simulator: TreeSimulator) -> tuple[float, Floats] | None:
    """
    Turn of a tree from the first of its kind, and key rotations to coordinates; None if unlike.

    Each branch has axes e1, e2 and further key rotations of its own choice: what the solver says
    is turned into those of the first tree.
    """
    first, joints = kind.simulator, simulator.joints
    frames = first.joints['frame']
    chord, other = frames[:, 0], joints['frame'][:, 0]
    sine = (chord[:, 0] * other[:, 1] - chord[:, 1] * other[:, 0]).sum()
    angle = float(np.arctan2(sine, (chord[:, :2] * other[:, :2]).sum()))
    c, s = np.cos(angle), np.sin(angle)
    turn = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
    with_it = frames @ turn
    slopes = [
        each.bank.segments[name] for name in ('slope', 'tip_slope') for each in (first, simulator)
    ]
    if not np.allclose(with_it[:, 0], other, atol=1e-6) or not all(
        a.shape == b.shape and np.allclose(a, b, atol=1e-6)
        for a, b in zip(slopes[::2], slopes[1::2], strict=True)
    ):
        return None
    projection = kind.basis.projection.copy()
    signs = np.array([[1.0], [-1.0]])
    for branch, (like, joint) in enumerate(zip(first.joints, joints, strict=True)):
        told, own = (
            _further_turns(*each)
            for each in ((like, first.bank.segments), (joint, simulator.bank.segments))
        )
        if told.shape != own.shape:
            return None
        rows = told.reshape(len(told) // 3, 3, told.shape[1])
        told = np.einsum('sak,ab->sbk', rows, turn).reshape(own.shape)
        mix = np.eye(2 + own.shape[1])
        # Both say one rotation vector, x e2 - y e1.
        axes, own_axes = (signs * each[branch][[2, 1]] for each in (with_it, joints['frame']))
        mix[:2, :2] = axes @ own_axes.T
        if own.shape[1]:
            mix[2:, 2:], _, rank, _ = np.linalg.lstsq(told, own, rcond=1e-4)
            fits = np.allclose(told @ mix[2:, 2:], own, atol=1e-3 * np.abs(own).max())
            if rank < own.shape[1] or not fits:
                return None
        keys = slice(joint['coordinate'], joint['coordinate'] + len(mix))
        projection[:, keys] = kind.basis.projection[:, keys] @ mix
    return angle, projection


def _further_turns(joint: np.void, segments: NDArray[np.void]) -> Floats:
    """Vectors that tell what a unit of each further key rotation of a branch does, (3 m, k)."""
    k = int(joint['n_coordinates'])
    of_joint = (joint[n][:k] for n in ('reach', 'push', 'turn'))
    rows = [*turns_of_segments(joint, segments), *of_joint]
    return np.stack(rows)[:, 2:].transpose(0, 2, 1).reshape(3 * len(rows), -1)


def _runner(simulator: TreeSimulator, is_running: bool) -> SwaySimulator:
    """Choose the simulator to find the basis on: this one if it is at rest and no dearer."""
    is_cheap = isinstance(simulator, SwaySimulator) and simulator.model != 'coupled'
    if isinstance(simulator, SwaySimulator) and is_cheap and not is_running:
        return simulator
    model = simulator.model if is_cheap else 'modes'
    settings = replace(simulator.settings, model=model, n_modes=None)
    return SwaySimulator(simulator.tree, simulator.species, settings)
