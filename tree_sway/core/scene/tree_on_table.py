# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""One tree of a shared table: its state seen as a tree of its own, on which pushes act."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.run import Bank, TableOscillators
from tree_sway.core.tree import Tree

if TYPE_CHECKING:
    from tree_sway.core.run import Touch


class TreeOnTable:
    """
    A tree of a shared table, in the frame of its kind.

    Parameters
    ----------
    tree, bank
        Its kind, and the kind's bank.
    oscillators
        Oscillators of the tree.

    """

    def __init__(self, tree: Tree, bank: Bank, oscillators: TableOscillators) -> None:
        self._tree = tree
        self._oscillators = oscillators
        self.bank = replace(bank, oscillators=self._oscillators)
        self._touch: Touch | None = None

    @property
    def touch(self) -> Touch:
        """Return the pushes on the tree; none at first."""
        from tree_sway.core.run import Touch

        if self._touch is None:
            self._touch = Touch(self._tree, self.bank)
        return self._touch

    def rotations(self) -> Floats:
        """Key rotations in [rad], (N,)."""
        shown = self._oscillators.rotations()
        return shown if self._touch is None else shown + self._touch.residual

    def step_pushes(self, own_dt: float, dt: float) -> bool:
        """
        Apply the pushes for a step of dt [s]; returns whether a moment was clamped.

        The step of the tree is that of its kind over its scale.
        """
        self._oscillators.modal.dt = own_dt
        return self.touch.step(self._placed, dt) > 0

    def _placed(self) -> Floats:
        """Place the tree as one of its kind, (n, 7)."""
        poses = np.zeros((self._tree.n_segments, 7))
        self.bank.place(self.rotations(), poses)
        return poses
