# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Leaves of a tree: mass and area on each branch for the solver, clusters on segments for the viewer.

Leaves are on branches without children, and on the thinner half of the wood by length. A tree has
as much leaf area as its stem can supply, but at most six times the ground that it covers: few
stands have a higher index (Asner, Scurlock & Hicke 2003). The wind meets the same part of it as
sunlight: leaves hide each other, ``F (1 - exp(-A / 2 F))`` for leaves of area A in every direction
in a crown of outline F (Monsi & Saeki 1953).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
import math

import numpy as np

from tree_sway.core.arrays import Floats, Ints
from tree_sway.core.checks import within
from tree_sway.core.rotation import quaternions_of_axes
from tree_sway.core.species import leaf_traits, LeafTraits, Look, look_of
from tree_sway.core.tree import Tree

MAX_LEAF_AREA_INDEX = 6.0
"""Largest leaf area over ground covered in [-]."""

_BLADE = 0.33
"""Area of a leaf over the square of its length [-], of one half as wide as it is long."""

_ALONG = (1.0, 0.0, 0.0)
"""Direction of a segment in its own frame."""

_GOLDEN_ANGLE = np.pi * (3.0 - np.sqrt(5.0))


@dataclass(frozen=True)
class Foliage:
    """Leaves of each branch: fresh mass [kg], one-sided and drag area [m^2], (b,)."""

    mass: Floats
    area: Floats
    drag_area: Floats


@dataclass(frozen=True)
class LeafClusters:
    """
    Clusters of leaves to be drawn, each on one segment; they flutter where they are drawn.

    Parameters
    ----------
    segment
        Segment of each cluster, (m,).
    offset
        Centre in the segment's frame in [m]: x along it from its root-side node, (m, 3).
    orientation
        Quaternion w x y z in the segment's frame, (m, 4): x away from the twig, z across the leaf.
    size
        Diameter in [m], (m,).
    frequency, phase
        Frequency and phase of the flutter in [Hz] and [rad], (m,).

    """

    segment: Ints
    offset: Floats
    orientation: Floats
    size: Floats
    frequency: Floats
    phase: Floats


def leafy_length(tree: Tree) -> Floats:
    """Length of each segment that bears leaves in [m], (n,)."""
    following = np.arange(1, tree.n_branches + 1)
    is_last = tree.subtree_end == following
    is_last[0] = False  # a stem alone bears leaves on its thinner half

    thin_first = np.argsort(tree.base_diameter, kind='stable')
    length_so_far = np.cumsum(tree.length[thin_first])
    half_length = 0.5 * length_so_far[-1]
    middle = thin_first[np.searchsorted(length_so_far, half_length)]
    thickest = tree.base_diameter[middle] * (1.0 + 1e-9)

    is_leafy = is_last[tree.branch_of_segment] | (tree.base_diameter <= thickest)
    return np.where(is_leafy, tree.length, 0.0)


def foliage_of(tree: Tree, *, traits: LeafTraits | None = None) -> Foliage:
    """Mass and area of the leaves on each branch, if any; traits of its species if None."""
    leaf = traits if traits is not None else leaf_traits(tree.species)
    leafy = leafy_length(tree)
    points = np.vstack([tree.start, tree.end])
    extent = np.ptp(points, axis=0)
    # A pole without branches covers the ground below its leaves.
    width = max(extent[0], leaf.size)
    depth = max(extent[1], leaf.size)
    leafy_ends = tree.end[leafy > 0.0]
    height = max(float(np.ptp(leafy_ends[:, 2])), leaf.size)
    ground_area = 0.25 * np.pi * width * depth
    outline = 0.25 * np.pi * np.sqrt(width * depth) * height

    supplied_area = leaf.area_per_section * stem_section(tree)
    total_area = min(supplied_area, MAX_LEAF_AREA_INDEX * ground_area)
    facing_area = outline * -np.expm1(-0.5 * total_area / outline)
    fraction = _sum_by_branch(tree, leafy) / leafy.sum()
    return Foliage(
        mass=leaf.fresh_mass * total_area * fraction,
        area=total_area * fraction,
        drag_area=facing_area * fraction,
    )


def stem_section(tree: Tree) -> float:
    """Area of the cross-section at the foot of the stem in [m^2]."""
    return 0.25 * np.pi * float(tree.base_diameter[0]) ** 2


def _sum_by_branch(tree: Tree, values: Floats) -> Floats:
    """Return the sums over the segments of each branch, (b,), of values (n,)."""
    return np.add.reduceat(values, tree.branch_first[:-1])


def clad_wood(tree: Tree, traits: LeafTraits) -> Floats:
    """Area of wood on each branch that is clad in needles in [m^2], (b,)."""
    if not traits.are_needles:
        return np.zeros(tree.n_branches)
    diameter = 0.5 * (tree.base_diameter + tree.tip_diameter)
    return _sum_by_branch(tree, diameter * leafy_length(tree))


def leaf_clusters(
    tree: Tree,
    rng: np.random.Generator,
    *,
    count: int = 1500,
    traits: LeafTraits | None = None,
    look: Look | None = None,
) -> LeafClusters:
    """
    Place clusters of leaves evenly along the outer wood of a tree at rest: at most one a leaf.

    Together they have the tree's leaf area, and their shoots stand and hang as those of the
    species; traits and look are those of the tree's species if None. Raises a `ParameterError` for
    a count below 0.
    """
    within('count', count, 0, 1e9)
    leaf = traits if traits is not None else leaf_traits(tree.species)
    shown = look if look is not None else look_of(tree.species)
    area = float(foliage_of(tree, traits=leaf).area.sum())
    leaf_area = _BLADE * leaf.size**2
    count = min(count, math.ceil(area / leaf_area))

    segment, along = _places(tree, count, rng)
    size = _sizes(tree.length[segment], area, leaf.size, rng)
    up = _up_in(tree.rest_frame[segment])
    away = _shoots(up, shown, leaf, rng)
    offset = 0.5 * size[:, None] * away
    offset[:, 0] += along
    return LeafClusters(
        segment=segment.astype(np.int64),
        offset=offset,
        orientation=_facing_up(away, up),
        size=size,
        frequency=leaf.flutter_frequency * rng.uniform(0.8, 1.25, count),
        phase=rng.uniform(0.0, 2.0 * np.pi, count),
    )


def _places(tree: Tree, count: int, rng: np.random.Generator) -> tuple[Ints, Floats]:
    """Return segments of clusters, and where along each from its root-side node [m], (m,)."""
    ends = np.cumsum(leafy_length(tree))
    number = np.arange(count) + rng.uniform(0.1, 0.9, count)
    place = number / max(count, 1) * ends[-1]
    segment = np.searchsorted(ends, place, side='right')
    segment = np.minimum(segment, tree.n_segments - 1)
    length = tree.length[segment]
    to_tip = np.clip(ends[segment] - place, 0.0, length)
    return segment, length - to_tip


def _sizes(length: Floats, area: float, leaf_size: float, rng: np.random.Generator) -> Floats:
    """
    Return the diameters of clusters [m] on segments of a length [m], (m,).

    Leaves overlap: clusters together have the leaf area [m^2]. They are smaller on short twigs,
    but none is smaller than a leaf [m].
    """
    count = len(length)
    size = np.sqrt(length) * rng.uniform(0.8, 1.2, count)
    if count:
        mean_square = 4.0 * (area / count) / np.pi
        size *= np.sqrt(mean_square / np.mean(size**2))
    smallest = leaf_size * rng.uniform(0.8, 1.2, count)
    return np.maximum(size, smallest)


def joined_clusters(clusters: Sequence[LeafClusters], n_segments: Sequence[int]) -> LeafClusters:
    """Join the leaves of trees, given their numbers of segments, into one record."""
    joined = {
        field.name: np.concatenate([getattr(each, field.name) for each in clusters])
        for field in fields(LeafClusters)
    }
    first_segment = np.cumsum([0, *n_segments[:-1]])
    n_clusters = [len(each.segment) for each in clusters]
    joined['segment'] = joined['segment'] + np.repeat(first_segment, n_clusters)
    return LeafClusters(**joined)


def _up_in(rest: Floats) -> Floats:
    """Return the upward direction in frames w x y z, (n, 3)."""
    w, x, y, z = rest.T
    up_x = 2.0 * (x * z - w * y)
    up_y = 2.0 * (y * z + w * x)
    up_z = 1.0 - 2.0 * (x * x + y * y)
    return np.stack([up_x, up_y, up_z], axis=1)


def _shoots(up: Floats, look: Look, leaf: LeafTraits, rng: np.random.Generator) -> Floats:
    """Directions of shoots in the frames of their segments: around a twig, or left and right."""
    count = len(up)
    turn = _GOLDEN_ANGLE * np.arange(count) + rng.uniform(-0.3, 0.3, count)
    around = np.stack([np.zeros(count), np.cos(turn), np.sin(turn)], axis=1)
    if leaf.are_needles and look.form != 'tufts':
        beside = np.cross(_ALONG, up)
        levelness = np.linalg.norm(beside, axis=1)
        left_or_right = np.where(np.arange(count) % 2, 1.0, -1.0)
        spread = left_or_right * rng.uniform(0.6, 1.2, count)
        is_level = levelness > 0.3  # the sides of an upright shoot are all alike
        scale = (spread / levelness)[is_level]
        around[is_level] = scale[:, None] * beside[is_level]
    angle = look.shoot_angle * rng.uniform(0.7, 1.3, count)
    away = np.sin(angle)[:, None] * around
    away[:, 0] += np.cos(angle)
    droop = look.droop * rng.uniform(0.7, 1.3, count)
    away -= droop[:, None] * up
    length = np.linalg.norm(away, axis=1)
    vanishes = length < 1e-3
    away[vanishes] = _ALONG
    length[vanishes] = 1.0
    return np.asarray(away / length[:, None])


def _facing_up(away: Floats, up: Floats) -> Floats:
    """Orientations w x y z with x away from the twig and z as upright as possible."""
    upward = np.einsum('ij,ij->i', up, away)
    z = up - upward[:, None] * away
    # A leaf that points straight up may face any direction.
    is_upright = np.linalg.norm(z, axis=1) < 1e-3
    z[is_upright] = np.cross(away[is_upright], _ALONG)
    length = np.linalg.norm(z, axis=1)
    z /= length[:, None]
    return quaternions_of_axes(away, z)
