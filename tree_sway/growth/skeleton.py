# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A tree while it grows: shoots as lines of nodes, each on a node of an older one.

Shoots are added parents first, so that a backward pass sums from the tips to the root, and a
forward pass the other way.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.tree import Tree, tree_from_segments


@dataclass
class Shoot:
    """
    One future branch: nodes from base to tip in [m], (k + 1, 3), and its node on the parent.

    The parent is -1 for the stem; ``at`` is 1 .. k of the parent.
    """

    nodes: Floats
    parent: int = -1
    at: int = 0

    @property
    def n_segments(self) -> int:
        """Return the number of segments."""
        return len(self.nodes) - 1

    def tangent(self, node: int) -> Floats:
        """Return the unit vector (3,) of the segment that ends at a node; of the first at 0."""
        last = max(node, 1)
        along = self.nodes[last] - self.nodes[last - 1]
        return np.asarray(along / np.linalg.norm(along))


@dataclass
class Skeleton:
    """The shoots of a tree, parents first."""

    shoots: list[Shoot] = field(default_factory=list)

    def add(self, nodes: Floats, parent: int = -1, at: int = 0) -> int:
        """Add a shoot on a node of an older one and return its number."""
        self.shoots.append(Shoot(nodes, parent, at))
        return len(self.shoots) - 1

    @property
    def n_segments(self) -> int:
        """Return the number of segments of all shoots."""
        return sum(shoot.n_segments for shoot in self.shoots)

    def scale_to_height(self, height: float) -> None:
        """Scale it about its root to a height of its highest node above the root in [m]."""
        root = self.shoots[0].nodes[0].copy()
        top = max(float(shoot.nodes[:, 2].max()) for shoot in self.shoots)
        factor = height / (top - root[2])
        for shoot in self.shoots:
            shoot.nodes = (shoot.nodes - root) * factor

    def to_tree(self, diameters: Sequence[Floats], name: str, species: str) -> Tree:
        """Make the `Tree`, from diameters at the nodes of each shoot in [m], (k + 1,)."""
        first = np.cumsum([0] + [shoot.n_segments for shoot in self.shoots])
        parents: list[int] = []
        for shoot, begin in zip(self.shoots, first, strict=False):
            base = -1 if shoot.parent < 0 else int(first[shoot.parent]) + shoot.at - 1
            parents += [base, *range(begin, begin + shoot.n_segments - 1)]
        return tree_from_segments(
            np.concatenate([shoot.nodes[:-1] for shoot in self.shoots]),
            np.concatenate([shoot.nodes[1:] for shoot in self.shoots]),
            np.concatenate([np.stack([d[:-1], d[1:]], axis=1) for d in diameters]),
            parent=np.array(parents),
            branch=np.repeat(np.arange(len(self.shoots)), np.diff(first)),
            name=name,
            species=species,
        )
