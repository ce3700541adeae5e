# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The load step for whole levels of a tree at a time: `branch_loads` without a compiler.

The formulas and records are the same.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.arrays import Floats, Records
from tree_sway.core.model.records import WIDTH
from tree_sway.core.numpy_rotation import (
    cross,
    cross_matrix,
    quaternion_product,
    quaternion_rotated,
    quaternions_of,
    turned_by,
)
from tree_sway.core.setup.tree_motion import levels_of


class Bases(NamedTuple):
    """Motion of the bases: the fields of `WORK` of the same names."""

    velocity: Floats
    orientation: Floats
    rotation: Floats
    displacement: Floats
    arm: Floats

    @classmethod
    def at_rest(cls, count: int) -> Bases:
        """Return a number of bases at rest."""
        orientation = np.tile([1.0, 0.0, 0.0, 0.0], (count, 1))
        return cls(np.zeros((count, 6)), orientation, *np.zeros((3, count, 3)))


_FIELDS = (
    'parent', 'twist', 'damping_mode', 'load_rotation', 'load_mode', 'lever', 'speed', 'base',
    'arm', 'per_arm', 'spread', 'area', 'frame',
)  # fmt: skip
"""Fields of the records that the passes read."""


class NumpyPasses:
    """
    Outward pass, wind and inward pass over `Branch` records, parents before children.

    Subtrees are contiguous runs.
    """

    def __init__(self, branches: Records) -> None:
        """Read the fields of the records, and sort the branches by level."""
        self.air = np.zeros((len(branches), 3))
        """Wind in the turned frame of each base [m/s], (b, 3), of the last `wind_forces`."""
        self.wrench = np.zeros((len(branches), 6))
        """
        Force and moment on each branch and its subtree [N, N m], (b, 6), of the last `bent_loads`.
        """
        self._branch: dict[str, NDArray[Any]] = {
            name: np.ascontiguousarray(branches[name]) for name in _FIELDS
        }
        self._coupling = branches['coupling'] - cross_matrix(branches['base'])
        self._projector = np.ascontiguousarray(symmetric_matrices(branches['projector']))
        self.levels = levels_of(branches['parent'])
        column = np.arange(branches['load_mode'].shape[1])
        self.is_there = column < branches['n_coordinates'][:, None]
        self._column = np.where(self.is_there, branches['coordinate'][:, None] + column, 0)

    def per_branch(self, x: Floats) -> Floats:
        """Arrange values of coordinates (N,) by branch, padded with zeros, (b, c)."""
        return np.asarray(np.where(self.is_there, x[self._column], 0.0))

    def outward(self, x: Floats, v: Floats) -> Bases:
        """
        Move the bases by angles and rates (b, c).

        A base is displaced by d and turned by r on its parent. Its arm keeps its length, to second
        order: ``a (1 - d.d / 2 a.a) + d``. The rotation vector changes at the rate r', the base
        spins with ``r' + r x r' / 2 + r x (r x r') / 6``.
        """
        bases = Bases.at_rest(len(x))
        for level in self.levels:
            branch = {name: self._branch[name][level] for name in _OF_JOINTS}
            parent = branch['parent']
            base = branch['base']
            arm = branch['arm']
            per_arm = branch['per_arm'][:, None]
            moved = _sums(x[parent], branch['twist'])
            moving = _sums(v[parent], branch['twist'])
            rotation = moved[:, 3:]
            turning = moving[:, 3:]
            shift = moved[:, :3] + cross(rotation, base)
            shifting = moving[:, :3] + cross(turning, base)

            bent_arm = arm * (1.0 - per_arm * _dot(shift, shift)) + shift
            shifting -= 2.0 * per_arm * _dot(shift, shifting) * arm
            parent_velocity = bases.velocity[parent, :3]
            parent_spin = bases.velocity[parent, 3:]
            gyration = cross(rotation, turning)
            spin = parent_spin + turning + 0.5 * gyration + cross(rotation, gyration) / 6.0
            velocity = parent_velocity + cross(parent_spin, bent_arm) + shifting

            bases.velocity[level, :3] = turned_by(-rotation, velocity)
            bases.velocity[level, 3:] = turned_by(-rotation, spin)
            own_turn = quaternions_of(rotation)
            bases.orientation[level] = quaternion_product(bases.orientation[parent], own_turn)
            bases.rotation[level] = rotation
            bases.displacement[level] = shift
            bases.arm[level] = bent_arm
        return bases

    def wind_forces(
        self, bases: Bases, x: Floats, v: Floats, wind: Floats, per_speed_squared: float,
        compliance: Floats, impulse: Floats,
    ) -> Floats:  # fmt: skip
        """
        Find the force of the wind on each branch, in its turned frame, in [N], (b, 3).

        The wind in [m/s] is (3,), or (b, 3) at each branch; the impulse (b, 3) is written.
        """
        branch = self._branch
        back = bases.orientation * [1.0, -1.0, -1.0, -1.0]
        self.air = quaternion_rotated(back, branch['speed'][:, None] * wind)
        air = self.air - bases.velocity[:, :3]
        rotation = self.load_rotation(x)
        spin = turned_by(-rotation, bases.velocity[:, 3:])
        by_spin = np.einsum('bij,bi->bj', self._coupling, spin)
        by_own_motion = _sums(v, branch['damping_mode'])
        relative = turned_by(-rotation, air) - by_spin
        relative += compliance[:, None] * impulse - by_own_motion
        across = np.einsum('bij,bj->bi', self._projector, relative)
        square = np.maximum(np.einsum('bi,bi->b', relative, across), 0.0)
        spread = branch['spread'] * np.square(v[:, :2]).sum(axis=1)
        speed = np.sqrt(square + spread)
        drag = per_speed_squared * branch['area']
        share = 2.0 / (1.0 + np.sqrt(1.0 + 4.0 * compliance * drag * speed))
        per_speed = (drag * speed * share**2)[:, None]
        impulse[:] = per_speed * relative
        return np.asarray(per_speed * across)

    def at_bases(self, x: Floats, force: Floats) -> Floats:
        """Turn forces (b, 3) on branches at angles (b, c) into the frames of their bases."""
        return turned_by(self.load_rotation(x), force)

    def load_rotation(self, x: Floats) -> Floats:
        """Rotation vectors [rad] of the loaded pieces of branches at angles (b, c), (b, 3)."""
        return _sums(x, self._branch['load_rotation'])

    def own_loads(self, force: Floats) -> Floats:
        """Find the load along each chord and the moments on its key rotation in [N m], (b, 3)."""
        branch = self._branch
        own = _works(branch['load_mode'][:, :2], force)
        along_chord = np.einsum('bk,bk->b', branch['frame'][:, 0], force)
        pull = branch['lever'] * along_chord
        return np.hstack([pull[:, None], own])

    def bent_loads(self, bases: Bases, x: Floats, force: Floats, moment: Floats) -> Floats:
        """
        Write moments on the coordinates of a tree as it is bent and turned, (N,), in [N m].

        Forces (b, 3) are those of `wind_forces`; they are returned in the frame of the tree.
        """
        load_rotation = self.load_rotation(x)
        own = _works(self._branch['load_mode'], force)
        couple = np.einsum('bij,bj->bi', self._coupling, force)
        at_base = turned_by(load_rotation, force)
        wrench = np.hstack([at_base, turned_by(load_rotation, couple)])
        world = quaternion_rotated(bases.orientation, at_base)
        for level in reversed(self.levels):
            branch = {name: self._branch[name][level] for name in _OF_JOINTS}
            parent = branch['parent']
            per_arm = branch['per_arm'][:, None]
            rotation = bases.rotation[level]
            shift = bases.displacement[level]
            handed = turned_by(rotation, wrench[level, :3])
            turning = turned_by(rotation, wrench[level, 3:])
            on_parent = turning + cross(bases.arm[level], handed)
            np.add.at(wrench, parent, np.hstack([handed, on_parent]))

            # The transpose of the motion in `outward`.
            pull = handed - 2.0 * per_arm * _dot(branch['arm'], handed) * shift
            gyration = cross(turning, rotation)
            turn = turning + 0.5 * gyration + cross(gyration, rotation) / 6.0
            turn = turn + cross(branch['base'], pull)
            np.add.at(own, parent, _works(branch['twist'], np.hstack([pull, turn])))
        self.wrench = wrench
        moment[self._column[self.is_there]] = own[self.is_there]
        return world


_OF_JOINTS = ('parent', 'twist', 'base', 'arm', 'per_arm')
"""Fields of the joint of a branch to its parent."""


def _sums(amounts: Floats, modes: Floats) -> Floats:
    """Sum modes (b, c, k) times the amounts (b, c) of each, (b, k)."""
    return np.asarray(np.einsum('bc,bck->bk', amounts, modes))


def _works(modes: Floats, forces: Floats) -> Floats:
    """Return what forces (b, k) do per unit of modes (b, c, k), (b, c)."""
    return np.asarray(np.einsum('bck,bk->bc', modes, forces))


def _dot(a: Floats, b: Floats) -> Floats:
    """Scalar products of vectors (b, 3), (b, 1)."""
    return np.asarray((a * b).sum(axis=1, keepdims=True))


def symmetric_matrices(entries: Floats) -> Floats:
    """Return matrices (..., 3, 3) of their entries xx, yy, zz, xy, xz, yz, (..., 6)."""
    row_by_row = entries[..., [0, 3, 4, 3, 1, 5, 4, 5, 2]]
    return row_by_row.reshape(*entries.shape[:-1], 3, 3)


def copies_of(branches: Records, count: int) -> Records:
    """Return the records of a number of equal trees, one after another, for `NumpyPasses`."""
    copies = np.tile(branches, count)
    tree = np.repeat(np.arange(count), len(branches))
    copies['parent'] += np.where(copies['parent'] < 0, 0, tree * len(branches))
    copies['coordinate'] += tree * int(branches['n_coordinates'].sum())
    return copies


def of_slots(field: Floats, count: int) -> Floats:
    """Field of records in slots, (blocks, ..., 16), as rows of branches, (count, ...)."""
    rows = np.moveaxis(field, -1, 1)
    return rows.reshape(-1, *rows.shape[2:])[:count]


def into_slots(rows: NDArray[Any], field: NDArray[Any]) -> None:
    """Write rows of branches, (b, ...), into a field of records in slots."""
    block, slot = np.divmod(np.arange(len(rows)), WIDTH)
    field[block, ..., slot] = rows
