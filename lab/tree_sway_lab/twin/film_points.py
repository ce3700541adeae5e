# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Points as a tracker would follow them, without pictures: projected, noisy, fluttering, lost.

A fifth is lost for seconds at a time; a tenth flutters; the edge of a shadow drags others with it,
and a bird carries some away.
"""

from __future__ import annotations

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.tree import ends_of_poses, Tree
from tree_sway.twin.camera import Camera
from tree_sway_lab.twin.film_truth import FRAMES

_NOISE, _FLUTTER, _SHADOW, _BIRD = 0.12, 1.5, 4.0, 40.0


def followed_points(
    tree: Tree, poses: Floats, camera: Camera, rng: np.random.Generator, count: int = 150
) -> Floats:
    """Return the places in pixels of points of the tree in each picture, (k, count, 2)."""
    weight = tree.length * np.sqrt(tree.base_diameter)
    segment = rng.choice(tree.n_segments, count, p=weight / weight.sum())
    away = rng.random(count) * tree.length[segment]
    found = np.array(
        [camera.project(ends_of_poses(each[segment], away)[1]) for each in poses.astype(float)]
    )
    found += _NOISE * rng.normal(size=found.shape)
    k = len(found)
    flutters = rng.random(count) < 0.1
    found[:, flutters] += _FLUTTER * rng.normal(size=(k, int(flutters.sum()), 2))
    shadowed = rng.random(count) < 0.1
    drift = np.cumsum(rng.normal(size=(k, 1, 2)), axis=0) * _SHADOW / np.sqrt(5.0 * FRAMES)
    found[:, shadowed] += drift * (rng.random((1, int(shadowed.sum()), 1)) > 0.3)
    for first in range(0, k, 10 * FRAMES):
        near = found[first].copy()
        gone = np.linalg.norm(near - near[rng.integers(count)], axis=1) < 60.0
        rows = slice(first + FRAMES, first + 2 * FRAMES)
        moved = found[rows, gone]
        moved += np.linspace(0.0, _BIRD, len(moved))[:, None, None]
        found[rows, gone] = moved
    for first in range(FRAMES, k, 3 * FRAMES):
        lost = rng.random(count) < 0.2
        found[first : first + 3 * FRAMES, lost] = np.nan
    return found
