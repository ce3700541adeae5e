# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Placing of the trees of one kind, each where it stands."""

from __future__ import annotations

import numpy as np

from tree_sway.core.arrays import Floats, Ints, Records
from tree_sway.core.kernel import WHY_PLAIN
from tree_sway.core.model.records import zeros_in_lines
from tree_sway.core.run.bank import Bank
from tree_sway.core.run.placing_by_keys import placing_by_keys
from tree_sway.core.run.stand import place_stand
from tree_sway.core.run.table_model import WindBasisBank


class KindPlacing:
    """
    The records of a kind of tree, with the memory in which the kernel places one tree.

    Parameters
    ----------
    n_segments
        Number of its segments.
    bank, oscillators
        Its records in its own frame, and its table.

    """

    def __init__(self, n_segments: int, bank: Bank, oscillators: WindBasisBank) -> None:
        self._oscillators = oscillators
        self._segments = bank.segments
        self._blocks = zeros_in_lines(len(bank.blocks), bank.blocks.dtype)
        self._blocks[:] = bank.blocks
        self._bases = np.zeros_like(bank.bases)
        self._rotations = oscillators.room_for_rotations()
        self._poses = np.zeros((n_segments, 7))
        self._by_keys = placing_by_keys(bank.branches, bank.segments, self._blocks)

    def place(self, placements: Records, instances: Records, rows: Ints, out: Floats) -> None:
        """
        Place trees by their states.

        Parameters
        ----------
        placements, instances
            Records of all trees of the scene: where they stand, and their states, (t,).
        rows
            Numbers of the trees of this kind, and their first rows in the pose block, (w, 2).
        out
            Pose block to write, (n, 7).

        """
        if not WHY_PLAIN:
            place_stand(
                placements, instances, rows, self._oscillators.laid_shapes, self._segments,
                self._blocks, self._bases, self._rotations, self._poses, out,
            )  # fmt: skip
            return
        for number, first in rows.tolist():
            keys = self._oscillators.rotations_of(instances[number : number + 1])
            self.place_by_keys(placements[number], keys, out[first : first + len(self._poses)])

    def place_by_keys(self, placement: np.void, rotations: Floats, out: Floats) -> None:
        """Place a tree by its key rotations (N,) in [rad], in its own part of a pose block."""
        cosine = float(placement['cosine'])
        sine = float(placement['sine'])
        scale = float(placement['scale'])
        self._by_keys.place(rotations, placement['at'], out, cosine, sine, scale)
