# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Forces and moments on a tree, and the same on one of its kind, which is not turned or scaled.

A tree scaled by k moves k times as far by the same angles, against k^3 times the stiffness: its
forces are k^2 and its moments k^3 times those of its kind, the stiffness of a spring k times.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.core.arrays import Floats
from tree_sway.core.checks import array_to_read
from tree_sway.core.rotation import about_up
from tree_sway.core.scene.placed_tree import PlacedTree

if TYPE_CHECKING:
    from tree_sway.core.run import Spring


@dataclass(frozen=True)
class KindFrame:
    """The frame of a tree's kind, seen from where the tree stands."""

    tree: PlacedTree

    @property
    def _rotation_kind_world(self) -> Floats:
        """Return the rotation from the world to the kind, (3, 3)."""
        return about_up(-self.tree.yaw)

    def to_tree(self, force: Floats, moment: Floats) -> tuple[Floats, Floats]:
        """Return a force [N] and a moment [N m] on the kind, (3,), as they are on the tree."""
        rotation = self._rotation_kind_world
        scale = self.tree.scale
        return scale**2 * (force @ rotation), scale**3 * (moment @ rotation)

    def to_kind(self, force: ArrayLike | Spring) -> ArrayLike | Spring:
        """Return a force [N], (3,), or a spring on the tree as it is on its kind."""
        from tree_sway.core.run import Spring

        rotation = self._rotation_kind_world
        scale = self.tree.scale
        if not isinstance(force, Spring):
            return rotation @ array_to_read('push', force, (3,)) / scale**2
        root = np.array([self.tree.x, self.tree.y, self.tree.z])
        away = array_to_read('push', force.to, (3,)) - root
        return Spring(rotation @ away / scale + self.tree.tree.start[0], force.stiffness / scale)
