# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Placing what is frozen: a subtree that moves with its parent as one body.

Its base turns and goes with the segment it sits on, as that of any branch; from there on every
segment keeps its place and orientation relative to the base.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tree_sway_ros.core.arrays import Floats, Ints, Records
from tree_sway_ros.core.kernel import fused
from tree_sway_ros.core.motion.placing import turn_at
from tree_sway_ros.core.reduction.pruning import Pruning
from tree_sway_ros.core.rotation import product, rotated


@dataclass(frozen=True)
class RigidParts:
    """
    Frozen subtrees, ready to be placed.

    Parameters
    ----------
    parent
        Moving branch that each one sits on, its index among the moving ones, (t,).
    rows
        Its base segment, its first segment and one past its last, rows of the pose block, (t, 3).
    base_turn, offset
        Rotation of its base per unit of the parent's coordinates, (t, c, 3), and its base from
        that segment's start in its frame in [m], (t, 3).
    arm, rest
        Start of each segment of the tree from the base it moves with, at rest, in [m], (n, 3), and
        orientation at rest, w x y z, (n, 4); those of moving segments are not read.

    """

    parent: Ints
    rows: Ints
    base_turn: Floats
    offset: Floats
    arm: Floats
    rest: Floats

    @staticmethod
    def of(pruning: Pruning, branches: Records) -> RigidParts:
        """Lay out the frozen subtrees of a tree, by the `BRANCH` records of all of it, (b,)."""
        tree, tops = pruning.whole, pruning.tops
        first = tree.branch_first[tops]
        end = tree.branch_first[tree.subtree_end[tops]]
        base = np.zeros((tree.n_segments, 3))
        for row, past in zip(first, end, strict=True):
            base[row:past] = tree.start[row]
        return RigidParts(
            pruning.place_among_moving[tree.branch_parent[tops]],
            np.stack([tree.segment_parent[first], first, end], axis=1),
            branches['twist'][tops, :, 3:].copy(),
            branches['offset'][tops].copy(),
            tree.start - base,
            tree.rest_frame,
        )

    def place(self, branches: Records, bases: Floats, x: Floats, out: Floats) -> None:
        """
        Place the frozen segments in the whole pose block (n, 7), once the moving ones are.

        Records (m,), bases (m, 8) and key rotations (M,) are those of the moving branches.
        """
        _place(
            self.parent, self.rows, self.base_turn, self.offset, self.arm, self.rest,
            branches, bases, x, out,
        )  # fmt: skip


@fused
def _place(
    parents: Ints, rows: Ints, base_turn: Floats, offset: Floats, arm: Floats, rest: Floats,
    branches: Records, bases: Floats, x: Floats, out: Floats,
) -> None:  # fmt: skip
    for t in range(len(parents)):
        on, below = rows[t, 0], bases[parents[t]]
        w, i, j, k = turn_at(branches[parents[t]], base_turn[t], x)
        w, i, j, k = product(below[0], below[1], below[2], below[3], w, i, j, k)
        px, py, pz = rotated(
            out[on, 6], out[on, 3], out[on, 4], out[on, 5],
            offset[t, 0], offset[t, 1], offset[t, 2],
        )  # fmt: skip
        px, py, pz = px + out[on, 0], py + out[on, 1], pz + out[on, 2]
        # The rotation as a matrix: three products a row, many rows.
        xx, xy, xz = 1.0 - 2.0 * (j * j + k * k), 2.0 * (i * j - w * k), 2.0 * (i * k + w * j)
        yx, yy, yz = 2.0 * (i * j + w * k), 1.0 - 2.0 * (i * i + k * k), 2.0 * (j * k - w * i)
        zx, zy, zz = 2.0 * (i * k - w * j), 2.0 * (j * k + w * i), 1.0 - 2.0 * (i * i + j * j)
        for row in range(rows[t, 1], rows[t, 2]):
            a, b, c = arm[row, 0], arm[row, 1], arm[row, 2]
            out[row, 0] = px + xx * a + xy * b + xz * c
            out[row, 1] = py + yx * a + yy * b + yz * c
            out[row, 2] = pz + zx * a + zy * b + zz * c
            out[row, 6], out[row, 3], out[row, 4], out[row, 5] = product(
                w, i, j, k, rest[row, 0], rest[row, 1], rest[row, 2], rest[row, 3]
            )
