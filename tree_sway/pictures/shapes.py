# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Shapes of a tree on the picture plane: bark thick as it is, far branches paler, and leaves."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.arrays import Floats
from tree_sway.core.tree.species import bark_color, species_keys, species_named
from tree_sway.core.tree.tree import Tree
from tree_sway.pictures.leaf_drawing import leaf_blades, leaf_colors
from tree_sway.pictures.projection import Camera, Frame, frame_around

_SHADE, _HAZE = 0.68, 0.62
"""Brightness of near bark over that of bark in the sun; how far far bark fades to white."""
_TWIG = np.array([0.36, 0.28, 0.22])
_THICK = 0.004
"""Diameter over the height of the picture from which joints are closed by discs."""
_POT = '#b5694a'
_POT_RIM = '#c67f60'


class Shapes(NamedTuple):
    """
    Polygons, the far ones first: corners [m], (k, 2), each; colours, 0 to 1, (s, 3).

    Those with an edge, (s,), are drawn with one in their own colour, as they may be thinner than
    a point of the picture.
    """

    corners: list[Floats]
    colors: Floats
    has_edge: NDArray[np.bool_]


def tree_shapes(
    tree: Tree,
    start: Floats,
    end: Floats,
    camera: Camera,
    frame: Frame,
    leaves: tuple[Floats, Floats] | None = None,
) -> Shapes:
    """
    Return the shapes of a tree whose segments are from start to end now in [m], (n, 3) each.

    Leaves are the pose block of their clusters, (m, 7), and the diameters of these in [m], (m,).
    """
    base, tip = camera.project(start), camera.project(end)
    depth = _depth(0.5 * (start + end), frame)
    corners = list(_tapered(base, tip, tree))
    # Twigs are brown, whatever the colour of the bark that old wood has.
    old = np.clip(tree.base_diameter / (0.2 * tree.base_diameter[0]), 0.0, 1.0)[:, None]
    near = _SHADE * (_TWIG + old * (np.array(bark_color(tree.species)) - _TWIG))
    colors = near + _HAZE * depth[:, None] * (1.0 - near)
    away = 0.5 * (base[:, 2] + tip[:, 2])
    # Discs close the joints of thick wood, edges those of the rest.
    thick = np.flatnonzero(tree.base_diameter > _THICK * (frame.top - frame.bottom))
    corners += list(_discs(base[thick, :2], tree.base_diameter[thick]))
    colors, away = np.vstack([colors, colors[thick]]), np.append(away, away[thick])
    has_edge = np.ones(len(away), dtype=np.bool_)
    if leaves is not None and len(leaves[1]):
        blades, normal = leaf_blades(tree.species, *leaves)
        seen = camera.project(blades)
        depth = _depth(blades.mean(axis=1), frame)
        corners += list(seen[..., :2])
        colors = np.vstack([colors, leaf_colors(tree.species, normal, depth)])
        away = np.concatenate([away, seen[..., 2].mean(axis=1)])
        has_edge = np.concatenate([has_edge, np.zeros(len(seen), dtype=np.bool_)])
    far_first = np.argsort(-away)
    return Shapes([corners[i] for i in far_first], colors[far_first], has_edge[far_first])


def outline_at_rest(tree: Tree, camera: Camera) -> list[Floats]:
    """Corners of the segments at rest on the picture plane [m], to see how far a tree moved."""
    return list(_tapered(camera.project(tree.start), camera.project(tree.end), tree))


def _tapered(base: Floats, tip: Floats, tree: Tree) -> Floats:
    """Four corners of each segment on the picture plane, (n, 4, 2)."""
    along = tip[:, :2] - base[:, :2]
    across = np.stack([-along[:, 1], along[:, 0]], axis=1)
    across /= np.maximum(np.linalg.norm(across, axis=1), 1e-12)[:, None]
    at_base = 0.5 * tree.base_diameter[:, None] * across
    at_tip = 0.5 * tree.tip_diameter[:, None] * across
    a, b = base[:, :2], tip[:, :2]
    return np.stack([a - at_base, a + at_base, b + at_tip, b - at_tip], axis=1)


def _discs(middle: Floats, diameter: Floats) -> Floats:
    """Twelve corners of a disc at each point of the picture plane, (n, 12, 2)."""
    angle = np.arange(12) * np.pi / 6.0
    round_it = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    return np.asarray(middle[:, None] + 0.5 * diameter[:, None, None] * round_it)


def _is_potted(tree: Tree) -> bool:
    return tree.species in species_keys() and species_named(tree.species).habit == 'pot'


def _depth(points: Floats, frame: Frame) -> Floats:
    """How far back each point is, from 0 to 1; little in a tree that has no depth."""
    away = points[:, 1]
    span = max(float(np.ptp(away)), 0.3 * (frame.top - frame.bottom))
    return np.asarray(0.5 + (away - 0.5 * (away.min() + away.max())) / span)


def ground_shapes(
    tree: Tree, camera: Camera
) -> tuple[list[tuple[Floats, str]], tuple[tuple[float, float], float, float]]:
    """
    Return the outline of the pot or the ground of a tree on the picture plane [m].

    Corners and colour of each part of the pot of a pot plant; the ellipse of the shadow of any
    other: its middle, width and height.
    """
    frame = frame_around(np.vstack([tree.start, tree.end]), camera)
    x, y = camera.project(tree.start[0])[:2].tolist()
    width = 0.5 * (frame.right - frame.left)
    shadow = (x, y), width, width * max(float(np.sin(camera.elevation)), 0.03)
    if not _is_potted(tree):
        return [], shadow
    # As deep as the margin below the root allows.
    deep = 0.85 * (y - frame.bottom)
    wide = 1.05 * deep
    pot = []
    for color, above, below, high in ((_POT, 0.5, 0.37, 1.0), (_POT_RIM, 0.54, 0.54, 0.2)):
        sides = np.array([-above, above, below, -below])
        levels = np.array([0.0, 0.0, -high, -high])
        pot.append((np.column_stack([x + wide * sides, y + deep * levels]), color))
    return pot, shadow
