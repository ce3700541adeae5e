"""A segment as a closed mesh: a cone from base to tip, of flat sides."""

from __future__ import annotations

import numpy as np

from tree_sway_ros.core.arrays import Floats, Ints
from tree_sway_ros.core.tree.tree import Tree

SIDES = 8
"""Sides of a cone; its volume is .900 of the round one's."""


def cone_points(tree: Tree, segment: int) -> Floats:
    """
    Vertices of a segment in its own frame in [m]: origin at its start, x along it, (2 SIDES, 3).

    The ring at the start comes first, then the one at the end, each counter-clockwise about x.

    """
    angle = 2.0 * np.pi * np.arange(SIDES) / SIDES
    ring = np.stack([np.zeros(SIDES), np.cos(angle), np.sin(angle)], axis=1)
    base = 0.5 * tree.base_diameter[segment] * ring
    tip = 0.5 * tree.tip_diameter[segment] * ring
    tip[:, 0] = tree.length[segment]
    return np.vstack([base, tip])


def cone_triangles() -> Ints:
    """Triangles of the sides and both ends as vertex numbers, outward, (4 SIDES - 4, 3)."""
    i = np.arange(SIDES)
    j = (i + 1) % SIDES
    sides = np.vstack([np.stack([i, j, j + SIDES], 1), np.stack([i, j + SIDES, i + SIDES], 1)])
    fan = np.arange(1, SIDES - 1)
    base = np.stack([np.zeros_like(fan), fan + 1, fan], 1)
    tip = np.stack([np.full_like(fan, SIDES), SIDES + fan, SIDES + fan + 1], 1)
    return np.vstack([sides, base, tip]).astype(np.int64)


def rest_frames(tree: Tree) -> Floats:
    """
    Frame of each segment in the tree's at rest, as homogeneous matrices, (n, 4, 4).

    Origin at the segment's start, x along it; y is horizontal, or north where x is upright.

    """
    x = (tree.end - tree.start) / tree.length[:, None]
    y = np.stack([-x[:, 1], x[:, 0], np.zeros(len(x))], axis=1)
    norm = np.linalg.norm(y, axis=1)
    upright = norm < 1e-9
    y[upright] = (0.0, 1.0, 0.0)
    y /= np.where(upright, 1.0, norm)[:, None]
    frames = np.zeros((len(x), 4, 4))
    frames[:, :3, 0], frames[:, :3, 1], frames[:, :3, 2] = x, y, np.cross(x, y)
    frames[:, :3, 3] = tree.start
    frames[:, 3, 3] = 1.0
    return frames
