# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A broadleaf that stands alone: a short trunk that forks into limbs, and a rounded crown.

Limbs and their branches grow towards the surface of an ellipsoid and stop short of it; that alone
rounds the crown. The trunk loses itself in the crown.

"""

from __future__ import annotations

import numpy as np

from tree_sway_ros.core.arrays import Floats
from tree_sway_ros.core.growth.axis import GOLDEN_ANGLE, aim, direction_of, grow_axis, heading_of
from tree_sway_ros.core.growth.skeleton import Skeleton
from tree_sway_ros.core.growth.thickness import BREAST_HEIGHT, node_diameters
from tree_sway_ros.core.growth.twigs import add_twigs
from tree_sway_ros.core.tree.tree import Tree

# The crown, in units of the tree's height: centre and half-axes of an ellipsoid.
_CENTRE = np.array([0.0, 0.0, 0.58])
_HALF_AXES = np.array([0.39, 0.39, 0.43])


def grow_broadleaf(
    rng: np.random.Generator,
    *,
    height: float = 8.0,
    diameter: float = 0.18,
    name: str = "broadleaf",
    species: str = "broadleaf",
) -> Tree:
    """
    Grow a tree with a trunk, forks and a rounded crown.

    Parameters
    ----------
    rng
        Source of randomness; the same state gives the same tree.
    height
        Height in [m].
    diameter
        Diameter in [m] at breast height, or at the base of a tree below twice that height.
    name, species
        What the tree is called, and the key of its wood.

    """
    skeleton = Skeleton()
    trunk = skeleton.add(
        grow_axis(
            np.zeros(3), rng.uniform(0.0, 2.0 * np.pi), (1.57, 1.45), 0.70, 10, rng, wander=0.06
        )
    )
    roll = rng.uniform(0.0, 2.0 * np.pi)
    for i, node in enumerate((3, 4, 4, 5, 5, 6, 6, 7, 7, 8, 8, 9, 9, 10, 10)):
        here = node / 10.0
        azimuth = roll + i * GOLDEN_ANGLE + rng.uniform(-0.15, 0.15)
        elevation = 0.1 + 0.8 * here**2 + rng.uniform(-0.1, 0.1)
        _add_limb(skeleton, trunk, node, (azimuth, elevation), rng)
    skeleton.scale_to_height(height)
    at_height = BREAST_HEIGHT if height > 2.0 * BREAST_HEIGHT else 0.0
    diameters = node_diameters(
        skeleton, diameter, at_height=at_height, tip_diameter=0.003 * (height / 8.0) ** 0.5
    )
    return skeleton.to_tree(diameters, name, species)


def _add_limb(
    skeleton: Skeleton, trunk: int, at: int, heading: tuple[float, float], rng: np.random.Generator
) -> None:
    """Add a limb that turns up, with its branches left and right, above and below in turn."""
    origin = skeleton.shoots[trunk].nodes[at]
    azimuth, elevation = heading
    way = direction_of(azimuth, elevation + 0.1)
    length = max(0.75 * _reach(origin, way), 0.1) * rng.uniform(0.85, 1.0)
    rise = (elevation, min(elevation + 0.3, 1.4))
    limb = skeleton.add(grow_axis(origin, azimuth, rise, length, 8, rng, wander=0.09), trunk, at)
    roll = rng.uniform(0.0, np.pi)
    for i, node in enumerate((2, 3, 4, 5, 6, 7, 8, 8)):
        side = roll + i * GOLDEN_ANGLE + rng.uniform(-0.3, 0.3)
        way = aim(skeleton.shoots[limb].tangent(node), rng.uniform(0.6, 0.95), side)
        _add_branch(skeleton, limb, node, way, rng)


def _add_branch(
    skeleton: Skeleton, limb: int, at: int, way: Floats, rng: np.random.Generator
) -> None:
    """Add a branch of a limb with its twigs in a flat spray."""
    origin = skeleton.shoots[limb].nodes[at]
    azimuth, elevation = heading_of(way)
    length = float(np.clip(0.85 * _reach(origin, way), 0.06, 0.22)) * rng.uniform(0.8, 1.0)
    rise = (elevation, elevation + 0.35 * (1.0 - elevation))
    n_segments = 6 if length > 0.13 else 4
    nodes = grow_axis(origin, azimuth, rise, length, n_segments, rng, wander=0.11)
    branch = skeleton.add(nodes, limb, at)
    add_twigs(
        skeleton,
        branch,
        length=0.03 + 0.12 * length,
        polar=0.75,
        sides=(0.2, np.pi - 0.2),
        first_node=2,
        lift=0.2,
    )


def _reach(origin: Floats, way: Floats) -> float:
    """Distance from a point in the crown to its surface, 0 outside, in units of the height."""
    p, v = (origin - _CENTRE) / _HALF_AXES, way / _HALF_AXES
    a, b, c = float(v @ v), float(p @ v), float(p @ p) - 1.0
    square = b * b - a * c
    return max((-b + float(np.sqrt(square))) / a, 0.0) if square > 0.0 else 0.0
