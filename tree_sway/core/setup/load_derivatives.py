# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Derivatives of the wind load on a bent tree, for many shapes of motion in one pass.

This is `branch_loads` differentiated by hand, for all branches at once. A unit of each shape gives
every base a velocity and a spin. By virtual work, the load on a shape is the power of the changed
forces on the motion of that shape. Where the tree rotates below a constant force, the force does
work on other coordinates as well; in a storm that part is as large as the change of the force.

Two kinds of terms add up:

- *joints*, `_Joints`: how the base of each branch moves on its parent's, and how the constant
  force and moment at the joint change as the parent or the joint itself moves;
- *loads*, `_Loads`: how the wind load of each branch changes as the branch turns and moves.

**Damping takes energy from every motion.** A branch is loaded where it works, at the mean of its
motion, and damped at that same mean. What the drag on all its points takes more than that, the
excess, damps its own key rotations, each by itself.

Twists are (velocity, spin) and wrenches (force, moment). Both are about the root node and in the
frame of the tree unless another point and frame are named. [v] is the matrix of the cross product
with v. Rotations are exponential coordinates; their maps are taken to second order.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.arrays import Floats, Records, Singles
from tree_sway.core.numpy_rotation import cross, cross_matrix, quaternions_of
from tree_sway.core.setup.numpy_branch_loads import of_slots, symmetric_matrices
from tree_sway.core.setup.tree_motion import joint_motion, own_motion, sum_outward

_IDENTITY = np.eye(3)
_CHUNK = 256
"""Branches that are summed at once, so that intermediate results stay in the cache."""


class _Joints(NamedTuple):
    """
    Motion of the base of each branch on its parent's, and the work of the load at the joint.

    Parameters
    ----------
    twist
        Twist of the base per unit of the motion at the joint (displacement, rotation vector, in
        the frame of the parent's base), (b, 6, 6).
    by_parent
        Change of the load on the joint's motion per unit twist of the parent, (b, 6, 6).
    by_joint
        The same per unit of the joint's own motion, (b, 6, 6).

    """

    twist: NDArray[Any]
    by_parent: NDArray[Any]
    by_joint: NDArray[Any]


class _Loads(NamedTuple):
    """
    Wind load of each branch in its own turned frame, and what its change depends on.

    Parameters
    ----------
    to_branch
        Twist of the base in the frame and at the base of the branch, per unit twist about the
        root, (b, 6, 6).
    turn
        Rotation of the loaded pieces per unit of their rotation vector, (b, 3, 3).
    lever
        Displacement of the centre of the load per unit rotation of the base, (b, 3, 3).
    force, moment
        [f] and [m] of the present force and of its moment about the base, (b, 3, 3).
    by_turn
        Change of the force per unit rotation in the wind, (b, 3, 3).
    drag
        Change of the force per unit velocity of the air, (b, 3, 3).

    """

    to_branch: NDArray[Any]
    turn: NDArray[Any]
    lever: NDArray[Any]
    force: NDArray[Any]
    moment: NDArray[Any]
    by_turn: NDArray[Any]
    drag: NDArray[Any]


class LoadSlopes:
    """
    Derivatives of the load of a tree on some shapes by the motion of these shapes.

    Parameters
    ----------
    records
        Records of branches, work and loads that ``moments`` (`branch_loads.wind_moments`) writes.
    moments
        Function that finds the loads at a pose (N,), rates (N,) and a wind [m/s], (3,), of 1
        kg/m^3.
    shapes
        Key rotations of each shape, (N, m).

    """

    def __init__(
        self,
        records: tuple[Records, Records, Records],
        moments: Callable[[Floats, Floats, Floats], Floats],
        shapes: Floats,
    ) -> None:
        """Find the motion of each branch on its parent per unit of each shape."""
        branches, self._work, self._loads = records
        self._branches = branches
        count = len(branches)
        # Branches that carry others, and for each branch the place of its parent among them.
        self._bearing, self._on = np.unique(np.maximum(branches['parent'], 0), return_inverse=True)
        self._bearing_parents = np.r_[-1, self._on[self._bearing[1:]]]
        base = -cross_matrix(branches['base'])
        self._slide_at_rest = np.concatenate(
            [np.broadcast_to(_IDENTITY, (count, 3, 3)), base], axis=2
        )
        # A base keeps its distance from the parent's as it moves aside: second derivative of that.
        squares = self._slide_at_rest.swapaxes(1, 2) @ self._slide_at_rest
        self._shortening = -2.0 * branches['per_arm'][:, None, None] * squares
        self._moments = moments
        shapes = shapes.astype(np.float32)
        self._joint = joint_motion(branches, shapes)
        self._load_rotation = own_motion(branches, 'load_rotation', shapes)
        self._load_mode = own_motion(branches, 'load_mode', shapes)
        self._keys = _key_rotations(branches, shapes)
        load_mode = branches['load_mode'][:, :2]
        self._excess = load_mode, branches['damping_mode'][:, :2] - load_mode

    def __call__(self, x: Floats, wind: Floats) -> tuple[Singles, Singles]:
        """
        Differentiate modal loads by the amounts of the shapes, and by their rates, both (m, m).

        The first axis is the shape that moves, the second the one that is loaded; the tree is at
        x, (N,), without motion.
        """
        self._moments(x, np.zeros(len(x)), wind)
        frame = _rotations(self._work['orientation'])
        place = self._places(frame)
        joints = _Joints(*map(_single, self._joints(frame, place)))
        loads = _Loads(*map(_single, self._branch_loads(frame, place)))
        return self._summed(joints, loads)

    def _places(self, frame: Floats) -> Floats:
        """Return the bases of all branches on the bent tree, from the root, (b, 3)."""
        parent_frame = frame[self._bearing[self._on]]
        place: Floats = (parent_frame @ self._work['arm'][..., None])[..., 0]
        place += self._outward(place[self._bearing])[self._on]
        return place

    def _joints(self, frame: Floats, place: Floats) -> _Joints:
        branches = self._branches
        work = self._work
        count = len(self._branches)
        parent_frame = frame[self._bearing[self._on]]
        force = (frame @ work['wrench'][:, :3, None])[..., 0]
        moment = (frame @ work['wrench'][:, 3:, None])[..., 0]

        # Twist of the base by the motion at the joint: displacement, then rotation vector r, whose
        # spin is 1 + [r] / 2 + [r]^2 / 6 per unit.
        per_arm = branches['per_arm'][:, None, None]
        leaning = -2.0 * per_arm * _outer(branches['arm'], work['displacement'])
        slide = self._slide_at_rest + leaning @ self._slide_at_rest
        rotation = cross_matrix(work['rotation'])
        spin = np.zeros((count, 3, 6))
        spin[:, :, 3:] = _IDENTITY + 0.5 * rotation + rotation @ rotation / 6.0
        at_root = _blocks(parent_frame, cross_matrix(place) @ parent_frame, 0.0, parent_frame)
        twist = at_root @ np.concatenate([slide, spin], axis=1)

        # The parent turns under the constant force and moment at the joint.
        about_root = cross_matrix(moment + cross(place, force))
        force_cross = cross_matrix(force)
        by_parent = twist.swapaxes(1, 2) @ _blocks(0.0, force_cross, force_cross, about_root)

        # The joint itself moves: first its slide under the spin, then the second derivatives of
        # slide and spin, times force and moment in the frame of the parent.
        local_force = np.einsum('bji,bj->bi', parent_frame, force)
        local_moment = cross_matrix(np.einsum('bji,bj->bi', parent_frame, moment))
        by_joint = spin.swapaxes(1, 2) @ cross_matrix(local_force) @ slide
        along_arm = (branches['arm'] * local_force).sum(axis=1)[:, None, None]
        by_joint += along_arm * self._shortening
        second = (local_moment @ rotation - 2.0 * rotation @ local_moment) / 6.0
        by_joint[:, 3:, 3:] += 0.5 * local_moment + second
        return _Joints(twist, by_parent, by_joint)

    def _branch_loads(self, frame: Floats, place: Floats) -> _Loads:
        rotation_vector = of_slots(self._loads['rotation'], len(self._branches))
        own_frame = frame @ _rotations(quaternions_of(rotation_vector))
        to_own = own_frame.swapaxes(1, 2)
        to_branch = _blocks(to_own, -to_own @ cross_matrix(place), 0.0, to_own)
        rotation = cross_matrix(rotation_vector)
        turn = _IDENTITY - 0.5 * rotation + rotation @ rotation / 6.0
        air = (frame @ self._in_slots('air_velocity')[..., None])[..., 0]
        air = np.einsum('bji,bj->bi', own_frame, air)
        drag = self._drag(air)
        force = self._in_slots('own_force')
        lever = self._in_slots('coupling')
        moment = (lever @ force[..., None])[..., 0]
        return _Loads(
            to_branch,
            turn,
            lever.swapaxes(1, 2),
            cross_matrix(force),
            cross_matrix(moment),
            drag @ cross_matrix(air),
            drag,
        )

    def _summed(self, joints: _Joints, loads: _Loads) -> tuple[Singles, Singles]:
        """Sum the power of the changed loads over the branches."""
        at_bearing = joints.twist[self._bearing] @ self._joint[self._bearing]
        bases = self._outward(at_bearing)
        m = bases.shape[2]
        turning = np.zeros((m, m), dtype=np.float32)
        damping = np.zeros((m, m), dtype=np.float32)
        for first in range(0, len(self._branches), _CHUNK):
            rows = slice(first, first + _CHUNK)
            joint = self._joint[rows]
            parent = bases[self._on[rows]]
            twist = parent + joints.twist[rows] @ joint
            by_motion = joints.by_parent[rows] @ parent + joints.by_joint[rows] @ joint
            turning += _power(by_motion, joint)

            moves = loads.to_branch[rows] @ twist
            velocity = moves[:, :3]
            spin = moves[:, 3:]
            turned = loads.turn[rows] @ self._load_rotation[rows] + spin
            centre = loads.lever[rows] @ spin + velocity
            loaded = centre + self._load_mode[rows]
            force = loads.force[rows]
            moment = loads.moment[rows]
            turning -= _power(force @ turned, velocity)
            turning -= _power(moment @ turned + force @ velocity, spin)
            turning += _power(loads.by_turn[rows] @ turned, loaded)
            damping -= _power(loads.drag[rows] @ loaded, loaded)
        keys = self._keys.reshape(-1, m)
        excess = self._excess_damping(loads.drag).reshape(-1, 1)
        return turning, damping - keys.T @ (excess * keys)

    def _excess_damping(self, drag: Singles) -> Singles:
        """Find the damping of both key rotations of branches beyond that at the mean, (b, 2)."""
        load_mode, beyond = self._excess
        return _single(np.maximum(np.einsum('bci,bij,bcj->bc', load_mode, drag, beyond), 0.0))

    def _outward(self, joints: NDArray[Any]) -> NDArray[Any]:
        """Sum the motion at the joints of branches that carry others, from the root outward."""
        return sum_outward(self._bearing_parents, joints)

    def _in_slots(self, name: str) -> Floats:
        return of_slots(self._loads[name], len(self._branches))

    def _drag(self, air: Floats) -> Floats:
        """
        Differentiate `drag` by the air velocity at each branch, (b, 3), to (b, 3, 3).

        With the projector P across the branch, the force is area |P u| P u.
        """
        projector = symmetric_matrices(self._in_slots('projector'))
        across = (projector @ air[..., None])[..., 0]
        speed = np.sqrt(np.maximum((air * across).sum(axis=1), 0.0))[:, None, None]
        slope = speed * projector + _outer(across, across) / np.maximum(speed, 1e-12)
        return np.asarray(self._branches['area'][:, None, None] * slope)


def _key_rotations(branches: Records, shapes: NDArray[Any]) -> NDArray[Any]:
    """Return the key rotations of branches by shapes (N, m), zero where one lacks, (b, 2, m)."""
    both = np.arange(2)
    rows = np.minimum(branches['coordinate'][:, None] + both, len(shapes) - 1)
    has = both < branches['n_coordinates'][:, None]
    return np.where(has[..., None], shapes[rows], np.zeros_like(shapes[:1]))


def _single(values: Floats) -> Singles:
    return values.astype(np.float32)


def _power(moved: Singles, loaded: Singles) -> Singles:
    """Sum products of motion and load over branches and axes, both (b, k, m), to (m, m)."""
    m = moved.shape[2]
    return moved.reshape(-1, m).T @ loaded.reshape(-1, m)


def _outer(a: Floats, b: Floats) -> Floats:
    return np.asarray(a[:, :, None] * b[:, None, :])


def _blocks(
    upper_left: Floats | float,
    upper_right: Floats,
    lower_left: Floats | float,
    lower_right: Floats,
) -> Floats:
    """Return matrices (b, 6, 6) of four blocks (b, 3, 3), or numbers that fill them."""
    out = np.empty((len(lower_right), 6, 6))
    out[:, :3, :3] = upper_left
    out[:, :3, 3:] = upper_right
    out[:, 3:, :3] = lower_left
    out[:, 3:, 3:] = lower_right
    return out


def _rotations(quaternions: Floats) -> Floats:
    """Return matrices (b, 3, 3) of unit quaternions w x y z, (b, 4)."""
    turn = cross_matrix(quaternions[:, 1:])
    return np.asarray(_IDENTITY + 2.0 * (quaternions[:, :1, None] * turn + turn @ turn))
