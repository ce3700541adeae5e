# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The model `branch` of the native core: branches in blocks of sixteen (``native/branch.h``)."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from tree_sway.core.arrays import fields_of, Floats, Records
from tree_sway.core.model.records import WIDTH
from tree_sway.core.native import address, contiguous, LIBRARY


class BranchBlock:
    """``sway_branch_block`` of the header: sixteen branches."""

    speed: Annotated[Floats, WIDTH]
    area: Annotated[Floats, WIDTH]
    spread: Annotated[Floats, WIDTH]
    projector: Annotated[Floats, 6, WIDTH]
    damping_mode: Annotated[Floats, 2, 3, WIDTH]
    load_rotation: Annotated[Floats, 2, 3, WIDTH]
    load_mode: Annotated[Floats, 2, 3, WIDTH]
    chord_lever: Annotated[Floats, 3, WIDTH]
    compliance: Annotated[Floats, WIDTH]
    whole: Annotated[Floats, 8, WIDTH]
    half: Annotated[Floats, 6, WIDTH]
    guard: Annotated[Floats, 3, WIDTH]
    gust: Annotated[Floats, 3, WIDTH]
    drag_impulse: Annotated[Floats, 3, WIDTH]
    load: Annotated[Floats, 3, WIDTH]
    force: Annotated[Floats, 3, WIDTH]


BRANCH_BLOCK = np.dtype(fields_of(BranchBlock))


class BranchBlocks:
    """
    Branches that move each by itself, at rest.

    Parameters
    ----------
    branches
        Records of `Branch`, (b,).

    """

    def __init__(self, branches: Records) -> None:
        count = len(branches)
        self.records: Records = np.zeros(-(-count // WIDTH), BRANCH_BLOCK)
        self.state = np.zeros((2, 2 * count))
        """Key rotations [rad] and their rates [rad/s], (2, 2 b)."""
        self._slots = np.divmod(np.arange(count), WIDTH)
        for name in ('speed', 'area', 'spread', 'projector'):
            self.put(name, branches[name])
        for name in ('damping_mode', 'load_rotation', 'load_mode'):
            self.put(name, branches[name][:, :2])
        self.put('chord_lever', branches['lever'][:, None] * branches['frame'][:, 0])
        self._arguments = address(self.records), count, *map(address, self.state)

    def put(self, name: str, values: Floats) -> None:
        """Write a row for each branch, (b, ...)."""
        block, slot = self._slots
        self.records[name][block, ..., slot] = values

    def forces(self) -> Floats:
        """Force of the last step's wind on each branch in [N], (b, 3)."""
        block, slot = self._slots
        forces: Floats = self.records['force'][block, :, slot]
        return forces

    def step(self, wx: float, wy: float, wz: float, drag_density: float) -> int:
        """
        Step in a wind [m/s] of a drag density [kg/m^3].

        Returns how many loads were clamped, -1 if the motion is not finite.
        """
        return int(LIBRARY.sway_step_branches(*self._arguments, wx, wy, wz, drag_density))

    def equilibrium(self, stiffness: Floats, wind: Floats, drag_density: float) -> Floats:
        """
        Find the key rotations [rad], (2 b,), at rest in a wind [m/s], (3,).

        The stiffness is that of each branch [N m], (b,); no time step may have been set.
        """
        rotations = np.zeros(self.state.shape[1])
        records, count, *_ = self._arguments
        own = np.ascontiguousarray(stiffness, dtype=np.float64)
        LIBRARY.sway_rest_branches(
            records, count, *wind.tolist(), drag_density, contiguous(own, (count,)),
            address(rotations),
        )  # fmt: skip
        return rotations

    def reset(self) -> None:
        """Return to rest."""
        self.state[:] = 0.0
        for name in ('drag_impulse', 'load', 'force'):
            self.records[name] = 0.0
