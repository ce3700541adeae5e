# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Slopes of the wind load of a bent tree, by many shapes of motion in one pass.

`branch_loads` differentiated by hand, for all branches at once. A unit of each shape gives every
base a velocity and a spin; the load on a shape is the power of the changed forces on it, by
virtual work. Where the tree rotates below a constant force, the force does work on other
coordinates: in a storm that part is as large as the other.

Twists are (velocity, spin) and wrenches (force, moment); both are about the root node and in the
frame of the tree where no other point and frame are named.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.arrays import Floats, Records, Singles
from tree_sway.core.beams.beam import cross, cross_matrix
from tree_sway.core.numpy_rotation import quaternions_of
from tree_sway.core.setup.numpy_branch_loads import of_slots
from tree_sway.core.setup.tree_motion import joint_motion, levels_of, own_motion, sum_outward

_ONE = np.eye(3)
_TOGETHER = 256
"""Branches that are summed at once."""


class LoadSlopes:
    """
    Slopes of the load of a tree on some shapes by their motion.

    Parameters
    ----------
    records
        Records of branches, work and loads that ``moments`` writes, as `modal.wind_moments`.
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
        self._branches, count = branches, len(branches)
        bearing, self._on = np.unique(np.maximum(branches['parent'], 0), return_inverse=True)
        self._bearing, self._levels = bearing, levels_of(np.r_[-1, self._on[bearing[1:]]])
        base = -cross_matrix(branches['base'])
        self._free = np.concatenate([np.broadcast_to(_ONE, (count, 3, 3)), base], axis=2)
        self._bowed = (
            -2.0 * branches['per_arm'][:, None, None] * (self._free.swapaxes(1, 2) @ self._free)
        )
        self._moments = moments
        shapes = shapes.astype(np.float32)
        self._joint = joint_motion(branches, shapes)
        self._load_rotation, self._load_mode, self._damping_mode = (
            own_motion(branches, name, shapes)
            for name in ('load_rotation', 'load_mode', 'damping_mode')
        )

    def __call__(self, x: Floats, wind: Floats) -> tuple[Singles, Singles]:
        """
        Differentiate modal loads by the amounts of the shapes, and by their rates, both (m, m).

        The first axis is the shape that moves, the second the one that is loaded; the tree is at
        x, (N,), without motion.
        """
        self._moments(x, np.zeros(len(x)), wind)
        branches, work, count = self._branches, self._work, len(self._branches)
        on, parent = self._on, self._bearing[self._on]
        frame = _rotations(work['orientation'])
        frames = frame[parent]
        place = (frames @ work['arm'][..., None])[..., 0]
        place += self._outward(place[self._bearing])[on]
        force = (frame @ work['wrench'][:, :3, None])[..., 0]
        moment = (frame @ work['wrench'][:, 3:, None])[..., 0]

        # Each base on its parent's: its twist by that of the joint, and how the force and moment
        # at the joint change as the parent, or the joint itself, moves.
        per_arm, moved = branches['per_arm'][:, None, None], work['displacement']
        leant = -2.0 * per_arm * _outer(branches['arm'], moved)
        slide, spin = self._free + leant @ self._free, np.zeros((count, 3, 6))
        skew = cross_matrix(work['rotation'])
        spin[:, :, 3:] = _ONE + 0.5 * skew + skew @ skew / 6.0
        relative = np.concatenate([slide, spin], axis=1)
        twist = _blocks(frames, cross_matrix(place) @ frames, 0.0, frames) @ relative
        pulled, bent = (np.einsum('bji,bj->bi', frames, each) for each in (force, moment))
        force_cross = cross_matrix(force)
        about_root = cross_matrix(moment + cross(place, force))
        by_parent = twist.swapaxes(1, 2) @ _blocks(0.0, force_cross, force_cross, about_root)
        by_joint = spin.swapaxes(1, 2) @ cross_matrix(pulled) @ slide
        # The second derivatives of slide and spin times both.
        by_joint += (branches['arm'] * pulled).sum(axis=1)[:, None, None] * self._bowed
        bent = cross_matrix(bent)
        by_joint[:, 3:, 3:] += 0.5 * bent + (bent @ skew - 2.0 * skew @ bent) / 6.0

        # Each branch on its base, in its own turned frame.
        own = of_slots(self._loads['rotation'], count)
        turn = frame @ _rotations(quaternions_of(own))
        back = turn.swapaxes(1, 2)
        moving = _blocks(back, -back @ cross_matrix(place), 0.0, back)
        own = cross_matrix(own)
        seeing = _ONE - 0.5 * own + own @ own / 6.0
        air = (frame @ self._in_slots('air_velocity')[..., None])[..., 0]
        air = np.einsum('bji,bj->bi', turn, air)
        drag = self._drag(air)
        own_force, lever = self._in_slots('own_force'), self._in_slots('coupling')
        forces, moments = (
            cross_matrix(each) for each in (own_force, (lever @ own_force[..., None])[..., 0])
        )
        small: list[Any] = [
            each.astype(np.float32) for each in (
                twist, by_parent, by_joint, moving, seeing, lever.swapaxes(1, 2), forces, moments,
                drag @ cross_matrix(air), drag,
            )
        ]  # fmt: skip
        bases = self._outward(small[0][self._bearing] @ self._joint[self._bearing])
        m = bases.shape[2]
        turning, damping = np.zeros((2, m, m), dtype=np.float32)
        for first in range(0, count, _TOGETHER):  # intermediate results stay in the cache
            rows = slice(first, first + _TOGETHER)
            twist, by_parent, by_joint, moving, seeing, lever, forces, moments, gain, drag = (
                each[rows] for each in small
            )
            joint, parents = self._joint[rows], bases[on[rows]]
            moves = moving @ (parents + twist @ joint)
            seen = seeing @ self._load_rotation[rows] + moves[:, 3:]
            arm = lever @ moves[:, 3:] + moves[:, :3]
            work_at = arm + self._load_mode[rows]
            turning += _power(by_parent @ parents + by_joint @ joint, joint)
            turning -= _power(forces @ seen, moves[:, :3])
            turning -= _power(moments @ seen + forces @ moves[:, :3], moves[:, 3:])
            turning += _power(gain @ seen, work_at)
            damping -= _power(drag @ (arm + self._damping_mode[rows]), work_at)
        return turning, damping

    def _outward(self, joints: NDArray[Any]) -> NDArray[Any]:
        """Sum the joint motion of branches that have children from the root on."""
        return sum_outward(self._on[self._bearing], self._levels, joints)

    def _in_slots(self, name: str) -> Floats:
        return of_slots(self._loads[name], len(self._branches))

    def _drag(self, air: Floats) -> Floats:
        """Slope of `drag` by the wind on each branch, (b, 3), in its own frame, (b, 3, 3)."""
        projector = self._in_slots('projector')[:, [0, 3, 4, 3, 1, 5, 4, 5, 2]].reshape(-1, 3, 3)
        across = (projector @ air[..., None])[..., 0]
        speed = np.sqrt(np.maximum((air * across).sum(axis=1), 0.0))[:, None, None]
        slope = speed * projector + _outer(across, across) / np.maximum(speed, 1e-12)
        return np.asarray(self._branches['area'][:, None, None] * slope)


def _power(moved: Singles, loaded: Singles) -> Singles:
    """Sum products of motion and load by shapes, both (b, k, m), to (m, m)."""
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
    turn = cross_matrix(quaternions[:, 1:])
    return np.asarray(_ONE + 2.0 * (quaternions[:, :1, None] * turn + turn @ turn))
