# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
From segments and poses to a picture plane.

A camera without perspective looks level or from above; what it sees to the right and up are two
coordinates, what is away from it is the third.

"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from tree_sway_ros.core.arrays import Floats
from tree_sway_ros.core.tree.rest_frame import quaternions_from_x


@dataclass(frozen=True)
class Camera:
    """
    Where a picture is taken from.

    Parameters
    ----------
    azimuth
        Heading of the line of sight in [rad], from x towards y: pi/2 looks north, and east (+x) is
        to the right.
    elevation
        How far the camera looks down in [rad].

    """

    azimuth: float = np.pi / 2.0
    elevation: float = 0.12

    def project(self, points: ArrayLike) -> Floats:
        """Right, up and away of points (..., 3), all in [m]."""
        sine, cosine = np.sin(self.azimuth), np.cos(self.azimuth)
        down, level = np.sin(self.elevation), np.cos(self.elevation)
        rows = np.array(
            [
                [sine, -cosine, 0.0],
                [cosine * down, sine * down, level],
                [cosine * level, sine * level, -down],
            ]
        )
        return np.asarray(np.asarray(points, dtype=np.float64) @ rows.T)

    def distance(self, points: ArrayLike) -> Floats:
        """How far back points (..., 3) stand in [m], whatever their height."""
        level = np.array([np.cos(self.azimuth), np.sin(self.azimuth), 0.0])
        return np.asarray(np.asarray(points, dtype=np.float64) @ level)


def ends_of_poses(poses: ArrayLike, length: ArrayLike) -> tuple[Floats, Floats]:
    """
    Nodes of segments from a pose block.

    Parameters
    ----------
    poses
        x y z and the quaternion's x y z w of each segment, (n, 7): its root-side node, and the
        rotation that turns x along it.
    length
        Length of each segment in [m], (n,).

    Returns
    -------
    start, end
        Root-side and tip-side nodes in [m], (n, 3) each.

    """
    block = np.asarray(poses, dtype=np.float64)
    start = block[:, :3]
    x, y, z, w = block[:, 3:].T
    along = np.stack(
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)], axis=1
    )
    return start, start + np.asarray(length, dtype=np.float64)[:, None] * along


def rest_poses(start: ArrayLike, end: ArrayLike) -> Floats:
    """Pose block (n, 7) of segments at rest: x along each by the shortest turn."""
    base = np.asarray(start, dtype=np.float64)
    along = np.asarray(end, dtype=np.float64) - base
    along = along / np.linalg.norm(along, axis=1)[:, None]
    return np.hstack([base, quaternions_from_x(along)[:, [1, 2, 3, 0]]])
