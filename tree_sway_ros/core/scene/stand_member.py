# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A tree of a stand as its state is told: its kind, turned and scaled, and how it bends now."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from tree_sway_ros.core.arrays import Floats
from tree_sway_ros.core.simulator.simulator import SwaySimulator
from tree_sway_ros.core.tree.tree import Tree


@dataclass(frozen=True, eq=False)
class StandMember:
    """
    One tree of a stand.

    Parameters
    ----------
    tree
        Where it stands, scaled and turned.
    kind
        The model that it shares with others of its kind, in a frame of its own.
    yaw
        How far it is turned about the vertical in [rad].
    rotations
        Called for its key rotations now in [rad], (N,).

    """

    tree: Tree
    kind: SwaySimulator
    yaw: float
    rotations: Callable[[], Floats]

    @property
    def model(self) -> str:
        """Model in use."""
        return self.kind.model

    @property
    def bank(self) -> Any:
        """Records of its kind."""
        return self.kind.bank
