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


class NumpyPasses:
    """
    Outward pass, wind and inward pass over `Branch` records, parents before children.

    Subtrees are contiguous runs.
    """

    def __init__(self, branches: Records) -> None:
        """Read the fields of the records, and sort the branches by level."""
        names = (
            'parent', 'twist', 'damping_mode', 'load_rotation', 'load_mode', 'lever',
            'speed', 'base', 'arm', 'per_arm',
        )  # fmt: skip
        self.air, self.wrench = np.zeros((len(branches), 3)), np.zeros((len(branches), 6))
        """
        Wind in the turned frame of each base [m/s], (b, 3), and force and moment on each branch
        and its subtree [N, N m], (b, 6), of the last `wind_forces` and `bent_loads`.
        """
        self._branch: dict[str, NDArray[Any]] = {
            name: np.ascontiguousarray(branches[name])
            for name in (*names, 'spread', 'area', 'frame')
        }
        self._coupling = branches['coupling'] - cross_matrix(branches['base'])
        xx, yy, zz, xy, xz, yz = branches['projector'].T
        self._projector = np.stack([xx, xy, xz, xy, yy, yz, xz, yz, zz], axis=1).reshape(-1, 3, 3)
        self.levels = levels_of(branches['parent'])
        column = np.arange(branches['load_mode'].shape[1])
        self.is_there = column < branches['n_coordinates'][:, None]
        self._column = np.where(self.is_there, branches['coordinate'][:, None] + column, 0)

    def per_branch(self, x: Floats) -> Floats:
        """Arrange values of coordinates (N,) by branch, padded with zeros, (b, c)."""
        return np.asarray(np.where(self.is_there, x[self._column], 0.0))

    def outward(self, x: Floats, v: Floats) -> Bases:
        """Move the bases by angles and rates (b, c)."""
        bases = Bases.at_rest(len(x))
        for level in self.levels:
            names = ('parent', 'twist', 'base', 'arm')
            parent, twist, at, arm = (self._branch[name][level] for name in names)
            moved, rate = (np.einsum('bc,bck->bk', each[parent], twist) for each in (x, v))
            rotation, spin = moved[:, 3:], rate[:, 3:]
            shift, slide = moved[:, :3] + cross(rotation, at), rate[:, :3] + cross(spin, at)
            per = self._branch['per_arm'][level, None]
            bent = arm * (1.0 - per * np.square(shift).sum(axis=1, keepdims=True)) + shift
            slide -= 2.0 * per * (shift * slide).sum(axis=1, keepdims=True) * arm
            parent_velocity = bases.velocity[parent]
            gyration = cross(rotation, spin)
            spin = parent_velocity[:, 3:] + spin + 0.5 * gyration + cross(rotation, gyration) / 6.0
            place = parent_velocity[:, :3] + cross(parent_velocity[:, 3:], bent) + slide
            moving = [turned_by(-rotation, each) for each in (place, spin)]
            bases.velocity[level] = np.hstack(moving)
            turned = quaternion_product(bases.orientation[parent], quaternions_of(rotation))
            bases.orientation[level], bases.rotation[level] = turned, rotation
            bases.displacement[level], bases.arm[level] = shift, bent
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
        u = turned_by(-rotation, air) - np.einsum('bij,bi->bj', self._coupling, spin)
        u += compliance[:, None] * impulse - np.einsum('bc,bck->bk', v, branch['damping_mode'])
        across = np.einsum('bij,bj->bi', self._projector, u)
        spread = branch['spread'] * np.square(v[:, :2]).sum(axis=1)
        speed = np.sqrt(np.maximum(np.einsum('bi,bi->b', u, across), 0.0) + spread)
        c = per_speed_squared * branch['area']
        share = 2.0 / (1.0 + np.sqrt(1.0 + 4.0 * compliance * c * speed))
        per_speed = (c * speed * share**2)[:, None]
        impulse[:] = per_speed * u
        return np.asarray(per_speed * across)

    def at_bases(self, x: Floats, force: Floats) -> Floats:
        """Turn forces (b, 3) on branches at angles (b, c) into the frames of their bases."""
        return turned_by(self.load_rotation(x), force)

    def load_rotation(self, x: Floats) -> Floats:
        """Rotation vectors [rad] of the loaded pieces of branches at angles (b, c), (b, 3)."""
        return np.asarray(np.einsum('bc,bck->bk', x, self._branch['load_rotation']))

    def own_loads(self, force: Floats) -> Floats:
        """Find the load along each chord and the moments on its key rotation in [N m], (b, 3)."""
        branch = self._branch
        own = np.einsum('bck,bk->bc', branch['load_mode'][:, :2], force)
        pull = branch['lever'] * np.einsum('bk,bk->b', branch['frame'][:, 0], force)
        return np.hstack([pull[:, None], own])

    def bent_loads(self, bases: Bases, x: Floats, force: Floats, moment: Floats) -> Floats:
        """
        Write moments on the coordinates of a tree as it is bent and turned, (N,), in [N m].

        Forces (b, 3) are those of `wind_forces`; they are returned in the frame of the tree.
        """
        branch = self._branch
        load_rotation = self.load_rotation(x)
        own = np.einsum('bck,bk->bc', branch['load_mode'], force)
        couple = turned_by(load_rotation, np.einsum('bij,bj->bi', self._coupling, force))
        wrench = np.hstack([turned_by(load_rotation, force), couple])
        world = quaternion_rotated(bases.orientation, wrench[:, :3])
        for level in reversed(self.levels):
            names = ('parent', 'twist', 'base', 'arm')
            parent, twist, at, arm = (branch[name][level] for name in names)
            rotation, shift = bases.rotation[level], bases.displacement[level]
            per = branch['per_arm'][level, None]
            f, m = (turned_by(rotation, wrench[level][:, k : k + 3]) for k in (0, 3))
            np.add.at(wrench, parent, np.hstack([f, m + cross(bases.arm[level], f)]))
            f = f - 2.0 * per * (arm * f).sum(axis=1, keepdims=True) * shift
            gyration = cross(m, rotation)
            m = m + 0.5 * gyration + cross(gyration, rotation) / 6.0 + cross(at, f)
            np.add.at(own, parent, np.einsum('bck,bk->bc', twist, np.hstack([f, m])))
        self.wrench = wrench
        moment[self._column[self.is_there]] = own[self.is_there]
        return world


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
