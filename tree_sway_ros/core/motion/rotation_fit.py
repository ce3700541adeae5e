# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Key rotations that come nearest to given poses: the way back from segments to branches.

From the root out, each branch's base is turned as placing would turn it; what its segments are
turned by beyond that is fitted by the branch's coordinates, by least squares weighted with
the lengths of the segments.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from tree_sway_ros.core.arrays import Floats, Ints, Records
from tree_sway_ros.core.kernel import fused
from tree_sway_ros.core.motion.fill_records import turns_of_segments
from tree_sway_ros.core.motion.placing import turn_at
from tree_sway_ros.core.rotation import product
from tree_sway_ros.core.tree.tree import Tree

_LEAST = 1e-4
"""Singular values of the turns of a branch, over the largest, below which they are none."""


class RotationFit:
    """Finds the key rotations of poses, by the records of a tree."""

    def __init__(self, tree: Tree, branches: Records, segments: Records) -> None:
        """Invert the shapes of every branch."""
        self._branches = branches
        self._rest = tree.rest_frame
        self._inverse = np.zeros((tree.n_segments, branches['push'].shape[1], 3))
        for b, branch in enumerate(branches):
            here = tree.segments_of(b)
            turns = turns_of_segments(branch, segments)
            root = np.repeat(np.sqrt(tree.length[here]), 3)
            columns = root[:, None] * turns.transpose(0, 2, 1).reshape(len(root), -1)
            inverse = (np.linalg.pinv(columns, rcond=_LEAST) * root).reshape(len(turns[0]), -1, 3)
            self._inverse[here, : len(turns[0])] = inverse.transpose(1, 0, 2)
        self._base = np.zeros((len(branches), 4))
        self._x = np.zeros(int(branches['n_coordinates'].sum()))

    def of(self, poses: Floats) -> Floats:
        """Return the key rotations (N,) of a pose block (n, 7) in [rad]; always the same array."""
        _fit(self._branches, self._inverse, self._rest, poses, self._base, self._x)
        return self._x


@fused
def _fit(
    branches: Records, inverse: Floats, rest: Floats, poses: Floats, bases: Floats, x: Floats
) -> None:
    x[:] = 0.0
    for b in range(len(branches)):
        branch = branches[b]
        i, base = branch.coordinate, bases[b]
        base[0], base[1], base[2], base[3] = 1.0, 0.0, 0.0, 0.0
        if branch.parent >= 0:
            w, a, c, d = turn_at(branches[branch.parent], branch.twist[:, 3:], x)
            p = bases[branch.parent]
            base[0], base[1], base[2], base[3] = product(p[0], p[1], p[2], p[3], w, a, c, d)
        for s in range(branch.first, branch.end):
            q, r = poses[s], rest[s]
            w, a, c, d = product(base[0], -base[1], -base[2], -base[3], q[6], q[3], q[4], q[5])
            w, a, c, d = product(w, a, c, d, r[0], -r[1], -r[2], -r[3])
            sine = np.sqrt(a * a + c * c + d * d)
            if w < 0.0:
                w, a, c, d = -w, -a, -c, -d
            factor = 2.0 * np.arctan2(sine, w) / sine if sine > 1e-12 else 2.0
            a, c, d = factor * a, factor * c, factor * d
            for k in range(branch.n_coordinates):
                per = inverse[s, k]
                x[i + k] += per[0] * a + per[1] * c + per[2] * d
        # Placing stretches the first shape by 1 + skew t: take that back.
        ux, uy = x[i], x[i + 1]
        for _ in range(4):
            stretch = 1.0 + branch.skew * (x[i] * x[i] + x[i + 1] * x[i + 1])
            x[i], x[i + 1] = ux / stretch, uy / stretch


def coordinates_within(branches: Records, moving: Ints, whole: Records) -> Any:
    """
    Lay the coordinates of a part of a tree out among those of the whole, sparse (N, M).

    Records of `BRANCH` of the part, (m,), may have less shapes or other axes; ``moving`` tells
    which branch of the whole each of them is, (m,).
    """
    rows, columns, values = [], [], []
    for local, b in zip(branches, moving, strict=True):
        row, column = int(whole['coordinate'][b]), int(local['coordinate'])
        further = np.arange(2, int(local['n_coordinates']))
        # x turns about e2 and y about -e1, as in `BRANCH`.
        axes, own = (each['frame'][[2, 1]] * [[1.0], [-1.0]] for each in (whole[b], local))
        rows += [row, row, row + 1, row + 1, *(row + further)]
        columns += [column, column + 1, column, column + 1, *(column + further)]
        values += [*(axes @ own.T).ravel(), *np.ones(len(further))]
    shape = (int(whole['n_coordinates'].sum()), int(branches['n_coordinates'].sum()))
    from scipy import sparse  # it takes long to load

    return sparse.csr_matrix((values, (rows, columns)), shape=shape)
