# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Draw a tree shoot by shoot: each a chain of nodes that wanders, rises or hangs."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.tree import Tree, tree_from_segments


class Shoot(NamedTuple):
    """Nodes of a shoot in [m], (m + 1, 3), and the number of its first segment."""

    nodes: Floats
    first: int

    def direction_at(self, node: int) -> Floats:
        """Return the unit vector along the segment that ends at a node."""
        chord: Floats = self.nodes[node] - self.nodes[node - 1]
        return chord / np.linalg.norm(chord)


class Drawing:
    """
    A tree in the making.

    Parameters
    ----------
    rng
        Source of what is random.

    """

    def __init__(self, rng: np.random.Generator) -> None:
        self.rng = rng
        self._rows: list[list[float]] = []
        self._parent: list[int] = []
        self._branch: list[int] = []

    def shoot(
        self,
        direction: Floats,
        length: float,
        diameter: tuple[float, float],
        segments: int,
        *,
        on: Shoot | None = None,
        node: int = -1,
        rise: float = 0.0,
        wander: float = 0.0,
    ) -> Shoot:
        """
        Add a shoot.

        Parameters
        ----------
        direction
            Unit vector along its first segment, (3,).
        length, diameter
            Its length, and its diameters at base and tip, in [m].
        segments
            How many it has.
        on, node
            The shoot and the node of it that it sits on; the ground if None.
        rise, wander
            Turn per segment towards the zenith, or to the ground if negative, and random turn per
            segment, root mean square, in [deg].

        """
        base = np.zeros(3) if on is None else on.nodes[node]
        carrying = -1 if on is None else on.first + node % len(on.nodes) - 1
        nodes = [base]
        for _ in range(segments):
            nodes.append(nodes[-1] + length / segments * direction)
            direction = lifted(direction, rise)
            direction = direction + math.radians(wander) * self.rng.standard_normal(3)
            direction /= np.linalg.norm(direction)
        path, first = np.array(nodes), len(self._rows)
        width = np.linspace(*diameter, segments + 1)
        self._rows += np.hstack([path[:-1], path[1:], width[:-1, None], width[1:, None]]).tolist()
        self._parent += [carrying, *range(first, first + segments - 1)]
        self._branch += [self._branch[-1] + 1 if self._branch else 0] * segments
        return Shoot(path, first)

    def tree(self, name: str) -> Tree:
        """Build the tree."""
        table = np.array(self._rows)
        return tree_from_segments(
            table[:, :3], table[:, 3:6], table[:, 6:], parent=np.array(self._parent),
            branch=np.array(self._branch), name=name,
        )  # fmt: skip


def towards(azimuth: float, elevation: float) -> Floats:
    """Return the unit vector at an azimuth from x and an elevation over the horizon in [deg]."""
    a, e = math.radians(azimuth), math.radians(elevation)
    return np.array([math.cos(a) * math.cos(e), math.sin(a) * math.cos(e), math.sin(e)])


def lifted(direction: Floats, angle: float) -> Floats:
    """Turn a unit vector by an angle in [deg] towards the zenith, no further than there."""
    level = math.hypot(direction[0], direction[1])
    now = math.atan2(direction[2], level)
    if level == 0.0 or angle == 0.0:
        return direction
    then = min(max(now + math.radians(angle), -0.5 * math.pi), 0.5 * math.pi)
    x, y = direction[0] / level, direction[1] / level
    return np.array([x * math.cos(then), y * math.cos(then), math.sin(then)])
