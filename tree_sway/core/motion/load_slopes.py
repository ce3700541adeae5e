# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Slopes of the wind load of a bent tree, by many shapes of motion in one pass.

`tree_passes` differentiated by hand, for all branches at once. A unit of each shape gives every
base a velocity and a spin; what loads a shape is the power of the changed forces on it, by virtual
work. Where a force stays as it is and the tree below it turns, it does work on other coordinates
than before: in a storm that part is as large as the other.

Twists are (velocity, spin) and wrenches (force, moment); both are about the root node and in the
frame of the tree where no other point and frame are named.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.arrays import Floats, Records, Singles
from tree_sway.core.motion.plain.numpy_passes import cross_matrices, of_lanes
from tree_sway.core.motion.plain.numpy_rotation import cross, quaternions_of
from tree_sway.core.motion.response import joint_motion, levels_of, own_motion, summed_outward

_ONE = np.eye(3)


class LoadSlopes:
    """
    What the load of a tree on some shapes changes by, as they move.

    Parameters
    ----------
    records
        Branches, work and loads that ``moments`` writes of a pose, as `modal.wind_moments` does.
    moments
        Find the loads at a pose (N,), at rates (N,) and in a wind [m/s], (3,), at 1 kg/m^3.
    shapes
        Key rotations of each shape, (N, m).

    """

    def __init__(
        self,
        records: tuple[Records, Records, Records],
        moments: Callable[[Floats, Floats, Floats], Floats],
        shapes: Floats,
    ) -> None:
        """Find what a unit of each shape does to each branch on its parent."""
        branches, self._work, self._loads = records
        self._branches, self._parents = branches, np.maximum(branches['parent'], 0)
        self._levels = levels_of(branches['parent'])
        self._moments = moments
        shapes = shapes.astype(np.float32)
        self._joint = joint_motion(branches, shapes)
        self._turn, self._loaded, self._damped = (
            own_motion(branches, name, shapes)
            for name in ('load_rotation', 'load_mode', 'damping_mode')
        )

    def __call__(self, x: Floats, wind: Floats) -> tuple[Singles, Singles]:
        """
        Differentiate modal loads by the amounts of the shapes, and by their rates, both (m, m).

        By the shape that moves, then the one that is loaded; the tree is still at x, (N,).
        """
        self._moments(x, np.zeros(len(x)), wind)
        branches, work, count = self._branches, self._work, len(self._branches)
        parent = self._parents
        frame = _rotations(work['attitude'])
        below = frame[parent]
        place = self._outward((below @ work['arm'][..., None])[..., 0])
        force = (frame @ work['wrench'][:, :3, None])[..., 0]
        moment = (frame @ work['wrench'][:, 3:, None])[..., 0]

        # Each base on its parent's: its twist by that of the joint, and by how much the force and
        # moment that it hands on load the joint more as the parent, or the joint itself, moves.
        slide, spin = _joints(branches, work)
        relative = np.concatenate([slide, spin], axis=1)
        twist = _blocks(below, cross_matrices(place) @ below, 0.0, below) @ relative
        pulled, bent = (np.einsum('bji,bj->bi', below, each) for each in (force, moment))
        carried = cross_matrices(force)
        about_root = cross_matrices(moment + cross(place, force))
        by_parent = twist.swapaxes(1, 2) @ _blocks(0.0, carried, carried, about_root)
        by_joint = spin.swapaxes(1, 2) @ cross_matrices(pulled) @ slide
        by_joint += _curvature(branches, work, pulled, bent)
        joints = twist.astype(np.float32) @ self._joint
        bases = self._outward(joints)
        handed_on = by_parent.astype(np.float32) @ bases[parent]
        handed_on += by_joint.astype(np.float32) @ self._joint

        # Each branch on its base, in its own frame as it is turned.
        own = of_lanes(self._loads['turned'], count)
        turn = frame @ _rotations(quaternions_of(own))
        back = turn.swapaxes(1, 2)
        moves = _blocks(back, -back @ cross_matrices(place), 0.0, back).astype(np.float32) @ bases
        own = cross_matrices(own)
        seen = (_ONE - 0.5 * own + own @ own / 6.0).astype(np.float32) @ self._turn + moves[:, 3:]
        air = np.einsum('bji,bj->bi', turn, (frame @ self._in_lanes('air')[..., None])[..., 0])
        drag = self._drag(air)
        push, couple = self._in_lanes('own_force'), self._in_lanes('coupling')
        arm = couple.swapaxes(1, 2).astype(np.float32) @ moves[:, 3:] + moves[:, :3]
        pushed = cross_matrices(push).astype(np.float32)
        coupled = cross_matrices((couple @ push[..., None])[..., 0]).astype(np.float32)
        borne = np.concatenate([-pushed @ seen, -coupled @ seen - pushed @ moves[:, :3]], axis=1)
        work_at = arm + self._loaded
        gained = (drag @ cross_matrices(air)).astype(np.float32) @ seen
        turning = _power(handed_on, self._joint) + _power(borne, moves) + _power(gained, work_at)
        return turning, -_power(drag.astype(np.float32) @ (arm + self._damped), work_at)

    def _outward(self, joints: NDArray[Any]) -> NDArray[Any]:
        return summed_outward(self._parents, self._levels, joints)

    def _in_lanes(self, name: str) -> Floats:
        return of_lanes(self._loads[name], len(self._branches))

    def _drag(self, air: Floats) -> Floats:
        """Slope of `drag` by the wind on each branch, (b, 3), in its own frame, (b, 3, 3)."""
        projector = self._in_lanes('projector')[:, [0, 3, 4, 3, 1, 5, 4, 5, 2]].reshape(-1, 3, 3)
        across = (projector @ air[..., None])[..., 0]
        speed = np.sqrt(np.maximum((air * across).sum(axis=1), 0.0))[:, None, None]
        slope = speed * projector + _outer(across, across) / np.maximum(speed, 1e-12)
        return np.asarray(self._branches['area'][:, None, None] * slope)


def _joints(branches: Records, work: Records) -> tuple[Floats, Floats]:
    """
    How each base moves, and how it spins, by displacement and turn of its joint, both (b, 3, 6).

    In the frame of the parent's base: what `outward_pass` adds up.
    """
    shift, slide = work['shift'], np.zeros((len(branches), 3, 6))
    slide[:, :, :3], slide[:, :, 3:] = _ONE, -cross_matrices(branches['base'])
    slide -= 2.0 * branches['per_arm'][:, None, None] * _outer(branches['arm'], shift) @ slide
    turn, spin = cross_matrices(work['turn']), np.zeros((len(branches), 3, 6))
    spin[:, :, 3:] = _ONE + 0.5 * turn + turn @ turn / 6.0
    return slide, spin


def _curvature(branches: Records, work: Records, force: Floats, moment: Floats) -> Floats:
    """
    How a force and a moment, both (b, 3), load a joint by its own bend, (b, 6, 6).

    By what is loaded, then what moves: the second derivatives of `_joints` times both.
    """
    free = np.concatenate([np.broadcast_to(_ONE, (len(branches), 3, 3)),
                           -cross_matrices(branches['base'])], axis=2)  # fmt: skip
    along = (branches['arm'] * force).sum(axis=1)
    curvature = -2.0 * (branches['per_arm'] * along)[:, None, None] * free.swapaxes(1, 2) @ free
    bent, turn = cross_matrices(moment), cross_matrices(work['turn'])
    curvature[:, 3:, 3:] += 0.5 * bent + (bent @ turn - 2.0 * turn @ bent) / 6.0
    return np.asarray(curvature)


def _power(moved: Singles, loaded: Singles) -> Singles:
    """Sum products of what shapes move and what they load, both (b, k, m), to (m, m)."""
    m = moved.shape[2]
    return moved.reshape(-1, m).T @ loaded.reshape(-1, m)


def _outer(a: Floats, b: Floats) -> Floats:
    return np.asarray(a[:, :, None] * b[:, None, :])


def _blocks(
    upper: Floats | float, upper_right: Floats, lower: Floats | float, lower_right: Floats
) -> Floats:
    """Matrices (b, 6, 6) of four (b, 3, 3), or numbers that fill them."""
    out = np.empty((len(lower_right), 6, 6))
    out[:, :3, :3], out[:, :3, 3:], out[:, 3:, :3], out[:, 3:, 3:] = (
        upper, upper_right, lower, lower_right
    )  # fmt: skip
    return out


def _rotations(quaternions: Floats) -> Floats:
    """Matrices (b, 3, 3) of unit quaternions w x y z, (b, 4)."""
    turn = cross_matrices(quaternions[:, 1:])
    return np.asarray(_ONE + 2.0 * (quaternions[:, :1, None] * turn + turn @ turn))
