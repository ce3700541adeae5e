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
from tree_sway.core.tree.leaf_traits import LeafTraits
from tree_sway.core.tree.look import Look
from tree_sway.core.tree.species import leaf_traits, look_of
from tree_sway.core.tree.tree import Tree
from tree_sway.core.wind.convention import quaternions_of_axes

MAX_LEAF_AREA_INDEX = 6.0
"""Largest leaf area over ground covered in [-]."""

_BLADE = 0.33
"""Area of a leaf over the square of its length [-], of one half as wide as it is long."""

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
    carries_none = tree.subtree_end == np.arange(1, tree.n_branches + 1)
    carries_none[0] = False
    thin_first = np.argsort(tree.base_diameter, kind='stable')
    reached = np.cumsum(tree.length[thin_first])
    middle = int(np.searchsorted(reached, 0.5 * reached[-1]))
    limit = tree.base_diameter[thin_first[middle]] * (1.0 + 1e-9)
    is_leafy = carries_none[tree.branch_of_segment] | (tree.base_diameter <= limit)
    return np.where(is_leafy, tree.length, 0.0)


def foliage_of(tree: Tree, *, traits: LeafTraits | None = None) -> Foliage:
    """Mass and area of the leaves on each branch, if any; traits of its species if None."""
    leaf = traits if traits is not None else leaf_traits(tree.species)
    points = np.vstack([tree.start, tree.end])
    wide, deep, _ = np.ptp(points, axis=0)
    leafy = leafy_length(tree)
    bearing = tree.end[leafy > 0.0]
    high = max(float(np.ptp(bearing[:, 2])), leaf.size)
    # A pole without branches covers the ground below its leaves.
    ground = 0.25 * np.pi * max(wide, leaf.size) * max(deep, leaf.size)
    section = 0.25 * np.pi * float(tree.base_diameter[0]) ** 2
    total = min(leaf.area_per_section * section, MAX_LEAF_AREA_INDEX * ground)
    outline = 0.25 * np.pi * np.sqrt(max(wide, leaf.size) * max(deep, leaf.size)) * high
    facing = outline * -np.expm1(-0.5 * total / outline)
    share = np.add.reduceat(leafy, tree.branch_first[:-1]) / leafy.sum()
    return Foliage(leaf.fresh_mass * total * share, total * share, facing * share)


def clad_wood(tree: Tree, traits: LeafTraits) -> Floats:
    """Area of wood on each branch that is clad in needles in [m^2], (b,)."""
    if not traits.are_needles:
        return np.zeros(tree.n_branches)
    area = 0.5 * (tree.base_diameter + tree.tip_diameter) * leafy_length(tree)
    return np.add.reduceat(area, tree.branch_first[:-1])


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
    area = float(foliage_of(tree, traits=leaf).area.sum())
    count = min(count, math.ceil(area / (_BLADE * leaf.size**2)))
    ends = np.cumsum(leafy_length(tree))
    place = (np.arange(count) + rng.uniform(0.1, 0.9, count)) / max(count, 1) * ends[-1]
    segment = np.minimum(np.searchsorted(ends, place, side='right'), tree.n_segments - 1)
    along = tree.length[segment] - np.clip(ends[segment] - place, 0.0, tree.length[segment])
    # Leaves overlap: clusters have their shares of the leaf area, smaller on short twigs, but none
    # is smaller than a leaf.
    size = np.sqrt(tree.length[segment]) * rng.uniform(0.8, 1.2, count)
    size *= np.sqrt(4.0 * (area / count) / np.pi / np.mean(size**2)) if count else 1.0
    size = np.maximum(size, leaf.size * rng.uniform(0.8, 1.2, count))
    up = _up_in(tree.rest_frame[segment])
    away = _shoots(up, look if look is not None else look_of(tree.species), leaf, rng)
    offset = 0.5 * size[:, None] * away
    offset[:, 0] += along
    orientation = _facing_up(away, up)
    return LeafClusters(
        segment=segment.astype(np.int64),
        offset=offset,
        orientation=orientation,
        size=size,
        frequency=leaf.flutter_frequency * rng.uniform(0.8, 1.25, count),
        phase=rng.uniform(0.0, 2.0 * np.pi, count),
    )


def joined_clusters(clusters: Sequence[LeafClusters], n_segments: Sequence[int]) -> LeafClusters:
    """Join the leaves of trees, given their numbers of segments, into one record."""
    first = np.concatenate([[0], np.cumsum(n_segments)[:-1]])
    carriers = [each.segment + at for each, at in zip(clusters, first, strict=True)]
    columns = {
        field.name: np.concatenate([getattr(each, field.name) for each in clusters])
        for field in fields(LeafClusters)
    }
    return LeafClusters(**{**columns, 'segment': np.concatenate(carriers)})


def _up_in(rest: Floats) -> Floats:
    """Return the upward direction in frames w x y z, (n, 3)."""
    w, x, y, z = rest.T
    return np.stack([2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)], 1)


def _shoots(up: Floats, look: Look, leaf: LeafTraits, rng: np.random.Generator) -> Floats:
    """Directions of shoots in the frames of their segments: around a twig, or left and right."""
    count = len(up)
    turn = _GOLDEN_ANGLE * np.arange(count) + rng.uniform(-0.3, 0.3, count)
    around = np.stack([np.zeros(count), np.cos(turn), np.sin(turn)], axis=1)
    if leaf.are_needles and look.form != 'tufts':
        beside = np.cross([1.0, 0.0, 0.0], up)
        flat = np.linalg.norm(beside, axis=1)
        is_level = flat > 0.3  # the sides of an upright shoot are all alike
        side = np.where(np.arange(count) % 2, 1.0, -1.0) * rng.uniform(0.6, 1.2, count)
        around[is_level] = (side / flat)[is_level, None] * beside[is_level]
    angle = look.shoot_angle * rng.uniform(0.7, 1.3, count)
    away = np.sin(angle)[:, None] * around
    away[:, 0] += np.cos(angle)
    away -= look.droop * rng.uniform(0.7, 1.3, count)[:, None] * up
    size = np.linalg.norm(away, axis=1)
    away[size < 1e-3], size[size < 1e-3] = [1.0, 0.0, 0.0], 1.0
    return np.asarray(away / size[:, None])


def _facing_up(away: Floats, up: Floats) -> Floats:
    """Orientations w x y z with x away from the twig and z as upright as possible."""
    z = up - np.einsum('ij,ij->i', up, away)[:, None] * away
    size = np.linalg.norm(z, axis=1)
    # A leaf that points straight up may face any direction.
    z[size < 1e-3] = np.cross(away[size < 1e-3], [1.0, 0.0, 0.0])
    z /= np.linalg.norm(z, axis=1)[:, None]
    return quaternions_of_axes(away, z)
