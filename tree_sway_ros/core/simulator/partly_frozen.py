# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A calibrated tree some of whose branches move with their parents: between two models."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property

from tree_sway_ros.core.motion.drag import DragLaw
from tree_sway_ros.core.motion.fill_records import lanes, moving_records, segment_records
from tree_sway_ros.core.motion.rigid_placing import RigidParts
from tree_sway_ros.core.reduction.pruning import Bools, Pruning
from tree_sway_ros.core.simulator.assembly import Bank, CalibratedTree, Layer
from tree_sway_ros.core.wind.crown_wind import CrownDelays


class PartlyFrozenTree(CalibratedTree):
    """
    What is left to solve of a calibrated tree, its layers shared, when branches (b,) are frozen.

    With each goes all that it carries; the stem never does.
    """

    def __init__(self, whole: CalibratedTree, frozen: Bools) -> None:
        """Wait to be asked."""
        self.pruning = Pruning(whole.tree, frozen)
        tree = self.pruning.tree()
        super().__init__(tree, whole.species, whole.settings, plain=whole.plain)
        self._whole = whole

    def bank(self, model: str, n_modes: int | None = None) -> Bank:
        """Build the oscillators of a model, as `CalibratedTree.bank`, and lay out the frozen."""
        bank = super().bank(model, n_modes)
        bank.heads['n_bearing'] = bank.heads['n_lanes']
        return replace(
            bank,
            frozen=RigidParts.of(self.pruning, self._whole.layer(model).branches),
            n_frozen=int(self.pruning.frozen.sum()),
        )

    @property
    def drag_law(self) -> DragLaw:
        """Of the whole tree, wood and leaves."""
        return self._whole.drag_law

    @cached_property
    def crown_delays(self) -> CrownDelays:
        """When each moving branch meets a gust: as in the whole tree."""
        whole = self._whole.crown_delays
        return whole._replace(of_branch=whole.of_branch[self.pruning.moving])

    @cached_property
    def alone(self) -> Layer:
        """Every moving branch on its own."""
        return self._pruned(self._whole.alone)

    @cached_property
    def carried(self) -> Layer:
        """Return the moving branches that carry the others, one shape each."""
        return self._pruned(self._whole.carried)

    @cached_property
    def coupled(self) -> Layer:
        """Return the moving branches that carry the others, further shapes for the enriched."""
        return self._pruned(self._whole.coupled)

    def _pruned(self, layer: Layer) -> Layer:
        models = [layer.models[branch] for branch in self.pruning.moving]
        branches = moving_records(self.pruning, layer.branches)
        branches['block'], branches['lane'], _ = lanes(self.tree, models)
        segments = segment_records(self.tree, models)
        return Layer(
            models, self.pruning.reduction(layer.reduction), branches, segments, layer.mass
        )
