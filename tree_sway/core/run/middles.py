# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Middles of the segments of a tree at key rotations, each times the square root of its mass."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property, partial

import numpy as np

from tree_sway.core.arrays import Floats, Singles
from tree_sway.core.kernel import entry_of, fused, part
from tree_sway.core.model.records import Blocks, Instances, Segments
from tree_sway.core.run.bank import Bank
from tree_sway.core.run.placing import GIVEN, place, room_for
from tree_sway.core.tree.segment_frame import ends_of_poses
from tree_sway.core.vector import plus_times, put, times, Vector, vector


class Middles:
    """
    Places the middles of segments.

    Parameters
    ----------
    bank
        Places the tree.
    mass, length
        Mass [kg] and length [m] of each segment, (n,).

    """

    def __init__(self, bank: Bank, mass: Floats, length: Floats) -> None:
        self._bank = bank
        self._root_mass = np.sqrt(mass)
        self._half_length = 0.5 * length
        self._poses = np.zeros((len(mass), 7))
        self.tangent = np.zeros(3 * len(mass))
        """Directions of the segments at the first pose of the last `fill`, (3 n,)."""

    def at(self, rotations: Floats) -> Floats:
        """Return the middles at key rotations (N,), one after another, (3 n,)."""
        out = np.zeros((1, 3 * len(self._root_mass)))
        self.fill(np.ascontiguousarray(rotations)[None], out, 1)
        return out[0]

    @cached_property
    def fill(self) -> Callable[[Floats, Floats, int], None]:
        """
        Write the middles at the first of some key rotations, as a function.

        Its arguments are key rotations (k, N), the middles to write, (k, 3 n), and how many poses
        are asked for.
        """
        if self._bank.plain:
            return self._fill_by_numpy
        bank = self._bank
        n_coordinates = int(bank.branches['n_coordinates'].sum())
        arrays = (
            *GIVEN, bank.segments, bank.blocks, bank.bases, room_for(n_coordinates),
            self._root_mass, self._half_length, self._poses, np.zeros(3), self.tangent,
        )  # fmt: skip
        given = np.zeros((1, 1)), np.zeros((1, 1)), 1
        return partial(entry_of(_fill, *arrays, *given), *arrays)

    def _fill_by_numpy(self, rotations: Floats, out: Floats, count: int) -> None:
        for k, (pose, middles) in enumerate(zip(rotations[:count], out, strict=False)):
            self._bank.place(pose, np.zeros(3), self._poses)
            start, at = ends_of_poses(self._poses, self._half_length)
            np.multiply(self._root_mass[:, None], at, out=middles.reshape(-1, 3))
            if k == 0:
                self.tangent[:] = ((at - start) / self._half_length[:, None]).ravel()


@fused
def _fill(
    instances: Instances, shapes: Singles, segments: Segments, blocks: Blocks, bases: Floats,
    room: Floats, root_mass: Floats, half_length: Floats, poses: Floats, origin: Floats,
    tangent: Floats, rotations: Floats, out: Floats, count: int,
) -> None:  # fmt: skip
    for k in range(count):
        place(
            instances, shapes, segments, blocks, bases, 1.0, 0.0, 1.0, room, rotations[k],
            origin, poses,
        )  # fmt: skip
        for i in range(len(half_length)):
            _write_middle(poses[i], root_mass[i], half_length[i], out[k], 3 * i)
            if k == 0:
                put(_axis(poses[i]), tangent, 3 * i)


@part
def _axis(pose: Floats) -> Vector:
    """Return the direction of the x axis of a pose."""
    x = pose[3]
    y = pose[4]
    z = pose[5]
    w = pose[6]
    return 1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)


@part
def _write_middle(
    pose: Floats, root_mass: float, half_length: float, middles: Floats, first: int
) -> None:
    """Write the middle of a segment, times the square root of its mass."""
    middle = plus_times(vector(pose, 0), half_length, _axis(pose))
    put(times(root_mass, middle), middles, first)
