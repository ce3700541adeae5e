"""Clusters of leaves as small polygons, lit from above."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from tree_sway_ros.core.tree import Floats
from tree_sway_ros.view.projection import Camera

# Each cluster is a short spray: where its blades sit along it, how they fan out and tilt in [rad].
_SEATS = np.array([-0.55, -0.3, -0.05, 0.15])
_FANS = np.array([0.95, -0.85, 0.7, -0.25])
_TILTS = np.array([0.35, -0.3, 0.4, -0.2])
_PER_CLUSTER = len(_SEATS)
# Blades of this length and shape show together the area of a disc as wide as the cluster.
_LENGTH = 0.9
_NEEDLE_LENGTH, _NEEDLE_WIDTH = 1.5, 0.65
_NEEDLES = ("goldcrest", "spruce", "sitka", "pine", "douglas_fir")
_GREEN = np.array([0.30, 0.50, 0.20])
_GREENS = {
    "goldcrest": np.array([0.63, 0.70, 0.22]),
    "spruce": np.array([0.20, 0.36, 0.22]),
    "sitka": np.array([0.26, 0.40, 0.30]),
    "pine": np.array([0.28, 0.42, 0.28]),
    "douglas_fir": np.array([0.22, 0.38, 0.20]),
    "benjamina": np.array([0.22, 0.45, 0.16]),
}
_SUN = np.array([-0.35, -0.5, 0.8])

# A blade of unit length along x, from its stalk to its tip.
_BLADE = np.array(
    [[0.0, 0.0], [0.3, 0.19], [0.6, 0.2], [1.0, 0.0], [0.6, -0.2], [0.3, -0.19]]
)


def leaf_blades(species: str, poses: Floats, size: Floats) -> tuple[Floats, Floats]:
    """
    Blades of every cluster.

    Parameters
    ----------
    species
        Key in the species table; blades of conifers are narrow.
    poses
        Pose block of the clusters, (m, 7), as of `leaf_poses`.
    size
        Diameter of each in [m], (m,).

    Returns
    -------
    corners, normal
        Corners of each blade in [m], (4 m, 6, 3), and the unit vector across it, (4 m, 3).

    """
    m = len(poses)
    cluster = Rotation.from_quat(np.repeat(poses[:, 3:], _PER_CLUSTER, axis=0))
    fan = np.column_stack([np.tile(_FANS, m), np.tile(_TILTS, m)])
    own = cluster * Rotation.from_euler("ZX", fan)
    length = _LENGTH * np.repeat(size, _PER_CLUSTER)
    blade = np.concatenate([_BLADE, np.zeros((len(_BLADE), 1))], axis=1)
    if species in _NEEDLES:
        blade = blade * [_NEEDLE_LENGTH, _NEEDLE_WIDTH, 1.0]
    corners = np.einsum("mij,kj->mki", own.as_matrix(), blade)
    seat = np.repeat(poses[:, :3], _PER_CLUSTER, axis=0)
    seat = seat + (np.tile(_SEATS, m) * length)[:, None] * cluster.apply([1.0, 0.0, 0.0])
    return seat[:, None] + length[:, None, None] * corners, own.apply([0.0, 0.0, 1.0])


def leaf_colors(species: str, normal: Floats, depth: Floats, camera: Camera) -> Floats:
    """
    Colour of each blade, (k, 3).

    Parameters
    ----------
    species
        Key in the species table.
    normal
        Unit vector across each, (k, 3).
    depth
        How far back each stands, 0 to 1, (k,).
    camera
        The light comes from above and over the viewer's left shoulder.

    """
    green = _GREENS.get(species, _GREEN)
    turn = camera.azimuth - 0.5 * np.pi
    sine, cosine = np.sin(turn), np.cos(turn)
    x, y, z = _SUN / np.linalg.norm(_SUN)
    sun = np.array([cosine * x - sine * y, sine * x + cosine * y, z])
    # A leaf shines through: lit from either side.
    light = 0.6 + 0.55 * np.abs(normal @ sun)
    color = np.clip(light[:, None] * green, 0.0, 1.0)
    return np.asarray(color + 0.45 * depth[:, None] * (1.0 - color))
