# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A spruce before a bright sky, picture by picture, and the clicks by which a person finds it."""

from __future__ import annotations

from typing import Any

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.tree import ends_of_poses, Tree
from tree_sway.growth import grow
from tree_sway.twin import place_on
from tree_sway.twin.camera import Camera, drawn_wood, looking

SIZE = 640, 480
CAMERA = Camera(np.array([0.0, -6.0, 1.5]), looking(0.0, 0.05, 0.0), 620.0, 0.5 * np.array(SIZE))


def spruce() -> Tree:
    """Return a spruce of 3 m."""
    return grow('spruce', 3.0, rng=np.random.default_rng(8))


def picture(cv2: Any, tree: Tree, poses: Floats) -> Any:
    """Draw a tree in poses (n, 7), in grey, (480, 640)."""
    bark = 30.0 + 90.0 * np.random.default_rng(2).random(tree.n_segments)
    drawn = np.full((SIZE[1] * 2, SIZE[0] * 2), 220, dtype=np.uint8)
    wood = drawn_wood(CAMERA, *ends_of_poses(poses, tree.length), tree.base_diameter)
    for s in np.argsort(-wood.depth).tolist():
        both = [tuple((32 * each).astype(int).tolist()) for each in (wood.first[s], wood.last[s])]
        thick = max(round(2 * float(wood.width[s])), 1)
        cv2.line(drawn, *both, float(bark[s]), thick, cv2.LINE_AA, 4)
    return cv2.resize(drawn, SIZE, interpolation=cv2.INTER_AREA)


def clicks(tree: Tree) -> str:
    """Return five clicks on the stem, and what is known of the camera."""
    lines = ['bearing=0', 'distance=6', 'height=1.5']
    for where in ('0', '0.7', '1.5', '2.2', '2.9'):
        place = place_on(tree, where)
        first, last = tree.start[place.segment], tree.end[place.segment]
        x, y = CAMERA.project((first + place.along * (last - first))[None])[0].tolist()
        lines.append(f'{x:.1f},{y:.1f},{where}')
    return ';\n'.join(lines)
