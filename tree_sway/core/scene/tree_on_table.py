# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""One tree of a shared table: its state seen as a tree of its own, on which pushes act."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from tree_sway.core.arrays import Floats, Records
from tree_sway.core.run.bank import Bank
from tree_sway.core.run.table_model import WindBasisBank
from tree_sway.core.tree.tree import Tree

if TYPE_CHECKING:
    from tree_sway.core.run.pushes import Touch


class TreeOnTable:
    """
    A tree of a shared table, in the frame of its kind.

    Parameters
    ----------
    tree, bank, oscillators
        Its kind, the kind's records and its table.
    instance
        State of the tree, a view, (1,).

    """

    def __init__(
        self, tree: Tree, bank: Bank, oscillators: WindBasisBank, instance: Records
    ) -> None:
        self._tree = tree
        self._oscillators = oscillators.with_state(instance)
        self.bank = replace(bank, oscillators=self._oscillators)
        self._touch: Touch | None = None

    @property
    def touch(self) -> Touch:
        """Return the pushes on the tree; none at first."""
        from tree_sway.core.run.pushes import Touch

        if self._touch is None:
            self._touch = Touch(self._tree, self.bank)
        return self._touch

    def rotations(self) -> Floats:
        """Key rotations in [rad], (N,)."""
        shown = self._oscillators.rotations()
        return shown if self._touch is None else shown + self._touch.residual

    def step_pushes(self, time_step: Records, dt: float) -> bool:
        """Apply the pushes for a step of dt [s]; returns whether a moment was clamped."""
        self._oscillators.time_step = time_step
        return self.touch.step(self._placed, self._tree.start[0], dt) > 0

    def _placed(self) -> Floats:
        """Place the tree as one of its kind, (n, 7)."""
        poses = np.zeros((self._tree.n_segments, 7))
        self.bank.place(self.rotations(), self._tree.start[0], poses)
        return poses
