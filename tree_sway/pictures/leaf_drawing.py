# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Clusters of leaves as small polygons, lit from above."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from tree_sway.core.arrays import Floats
from tree_sway.core.tree.species import leaf_traits


@dataclass(frozen=True)
class _Spray:
    """
    How a cluster is drawn: a short spray of blades that together show the area of a disc as wide.

    Places along the spray are in lengths of a blade; each fans out and turns about itself, in
    [rad].
    """

    places: Floats
    fans: Floats
    tilts: Floats
    length: float
    width: float


_LEAVES = _Spray(
    places=np.array([-0.55, -0.3, -0.05, 0.15]),
    fans=np.array([0.95, -0.85, 0.7, -0.25]),
    tilts=np.array([0.35, -0.3, 0.4, -0.2]),
    length=0.9,
    width=1.0,
)
_NEEDLES = _Spray(
    places=np.linspace(-0.7, 0.2, 9),
    fans=np.array([0.8, -0.7, 0.6, -0.8, 0.5, -0.5, 0.4, -0.35, 0.05]),
    tilts=np.linspace(-0.8, 0.8, 9),
    length=1.0,
    width=0.36,
)
_SUN = np.array([-0.35, -0.5, 0.8]) / np.linalg.norm([-0.35, -0.5, 0.8])

# A blade of unit length along x, from its stalk to its tip.
_BLADE = np.array([[0.0, 0.0], [0.3, 0.19], [0.6, 0.2], [1.0, 0.0], [0.6, -0.2], [0.3, -0.19]])


def blades_per_cluster(species: str) -> int:
    """Blades that a cluster of a species is drawn by."""
    return len(_spray_of(species).places)


def _spray_of(species: str) -> _Spray:
    return _NEEDLES if leaf_traits(species).are_needles else _LEAVES


def leaf_blades(species: str, poses: Floats, size: Floats) -> tuple[Floats, Floats]:
    """
    Blades of clusters at poses (m, 7) of diameters [m], (m,); conifers' are narrow and more.

    Returns
    -------
    corners, normal
        Corners of each blade in [m], (k m, 6, 3), and the unit vector across it, (k m, 3).

    """
    spray = _spray_of(species)
    m, k = len(poses), len(spray.places)
    cluster = Rotation.from_quat(np.repeat(poses[:, 3:], k, axis=0))
    turn = np.column_stack([np.tile(spray.fans, m), np.tile(spray.tilts, m)])
    own = cluster * Rotation.from_euler('ZX', turn)
    blade = np.column_stack([_BLADE[:, 0], spray.width * _BLADE[:, 1], np.zeros(len(_BLADE))])
    length = spray.length * np.repeat(size, k)
    base = np.repeat(poses[:, :3], k, axis=0)
    base = base + (np.tile(spray.places, m) * length)[:, None] * cluster.apply([1.0, 0.0, 0.0])
    corners = np.einsum('mij,kj->mki', own.as_matrix(), blade)
    return base[:, None] + length[:, None, None] * corners, own.apply([0.0, 0.0, 1.0])


def leaf_colors(species: str, normal: Floats, depth: Floats) -> Floats:
    """
    Colour of each blade by the unit vector across it and how far back it is, 0 to 1, (k, 3).

    The light comes from above and over the viewer's left shoulder.
    """
    green = np.array(leaf_traits(species).green)
    # A leaf shines through: lit from either side.
    light = 0.6 + 0.55 * np.abs(normal @ _SUN)
    color = np.clip(light[:, None] * green, 0.0, 1.0)
    return np.asarray(color + 0.45 * depth[:, None] * (1.0 - color))
