# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Loads of uniform winds on a tree that bends and moves, by the native core.

``native/branch_loads.h`` has the law. A load is a moment on each key rotation; by virtual work,
the load on a shape of motion is the power of these moments on it.
"""

from __future__ import annotations

import ctypes
from typing import Annotated

import numpy as np

from tree_sway.core.arrays import fields_of, Floats, Records
from tree_sway.core.native import address, contiguous, LIBRARY
from tree_sway.core.rotation import cross_matrix


class BranchLoad:
    """``sway_branch_load`` of the header: motion of a branch, and the load on it."""

    velocity: Annotated[Floats, 6]
    orientation: Annotated[Floats, 4]
    rotation: Annotated[Floats, 3]
    displacement: Annotated[Floats, 3]
    arm: Annotated[Floats, 3]
    turn: Annotated[Floats, 3]
    flow: Annotated[Floats, 3]
    own_force: Annotated[Floats, 3]
    force: Annotated[Floats, 3]
    wrench: Annotated[Floats, 6]


BRANCH_LOAD = np.dtype(fields_of(BranchLoad))

_OF_RECORDS = (
    'parent', 'coordinate', 'n_coordinates', 'twist', 'base', 'arm', 'per_arm', 'speed', 'area',
    'spread', 'projector', 'coupling', 'load_mode', 'damping_mode', 'load_rotation',
)  # fmt: skip


class Branches(ctypes.Structure):
    """``sway_branches`` of the header."""

    _fields_ = (
        ('branches', ctypes.c_int64),
        ('keys', ctypes.c_int64),
        *((name, ctypes.c_void_p) for name in _OF_RECORDS),
    )


class WindMoments:
    """
    Moments of winds on the key rotations of a tree.

    Parameters
    ----------
    branches
        Records of `Branch`, parents before their children, (b,); they are copied.

    """

    def __init__(self, branches: Records) -> None:
        own = {name: np.ascontiguousarray(branches[name]) for name in _OF_RECORDS}
        own['coupling'] = own['coupling'] - cross_matrix(own['base'])
        self._arrays = own
        at = {name: address(array) for name, array in own.items()}
        self.n_branches, keys = own['twist'].shape[:2]
        self._branches = Branches(branches=self.n_branches, keys=keys, **at)
        self._scratch = np.empty(333 * self.n_branches)
        self.n = int(own['n_coordinates'].sum())
        """Number of key rotations, N."""
        self.loads: Records = np.zeros(self.n_branches, BRANCH_LOAD)
        """Records of `BranchLoad` of the last pose, (b,)."""

    def __call__(self, x: Floats, v: Floats, wind: Floats) -> Floats:
        """Moments (N,) by a wind (3,) of 1 kg/m^3 on a tree at x that moves at v, both (N,)."""
        return self.at_poses(x[None], wind[None], v[None])[0]

    def at_poses(self, poses: Floats, winds: Floats, rates: Floats | None = None) -> Floats:
        """
        Find the moments of winds [m/s], (p, 3), of 1 kg/m^3 on the key rotations, (p, N).

        The tree is in poses [rad], (p, N), and moves at rates [rad/s], (p, N), or is held.
        """
        x, wind = (np.ascontiguousarray(each, dtype=np.float64) for each in (poses, winds))
        v = None if rates is None else np.ascontiguousarray(rates, dtype=np.float64)
        shape = len(wind), self.n
        out = np.empty(shape)
        LIBRARY.sway_wind_moments(
            ctypes.byref(self._branches), contiguous(x, shape),
            None if v is None else contiguous(v, shape), contiguous(wind, (len(wind), 3)),
            len(wind), address(self.loads), address(out),
        )  # fmt: skip
        return out

    def at_rest(self, winds: Floats, shapes: Floats) -> Floats:
        """Return loads of winds (k, 3) on shapes (N, m) of a tree at rest, (k, m), at 1 kg/m^3."""
        rest = np.zeros((len(winds), self.n))
        return np.asarray(self.at_poses(rest, winds) @ shapes)

    def forces(self, x: Floats, v: Floats, wind: Floats) -> Floats:
        """Find the forces on the branches, (b, 3), by a wind as in a call, in the tree's frame."""
        self(x, v, wind)
        return np.asarray(self.loads['force'])

    def find_slopes(
        self, x: Floats, wind: Floats, shapes: Floats, turning: Floats, damping: Floats
    ) -> None:
        """
        Find the changes of moments on a still tree by motion along shapes, and by its rates.

        The tree is at x, (N,), in a wind, (3,); shapes are (N, c), c a multiple of 8, and so are
        the changes, which are written. Memory is the caller's: to take it anew takes as long as
        to fill it.
        """
        shape = self.n, shapes.shape[1]
        LIBRARY.sway_load_slopes(
            ctypes.byref(self._branches), contiguous(x, (self.n,)), contiguous(wind, (3,)),
            contiguous(shapes, shape), shapes.shape[1], address(self._scratch),
            contiguous(turning, shape), contiguous(damping, shape),
        )  # fmt: skip
