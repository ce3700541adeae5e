# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Trees on the axes of matplotlib: bark in its true thickness, leaves, and paler colours far away.

The view is without perspective from the south, a little from above: east is right.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.core.arrays import Floats
from tree_sway.core.leaves import LeafClusters
from tree_sway.core.species import leaf_traits, look_of
from tree_sway.core.tree import ends_of_poses, Tree
from tree_sway.pictures.leaves_in_place import leaf_poses

if TYPE_CHECKING:
    from matplotlib.axes import Axes

ELEVATION = 0.12
"""Angle of the view below the horizon in [rad]."""
_MARGIN = 0.06
_SHADE, _HAZE = 0.68, 0.5
"""Brightness of near bark over that of bark in the sun; share of white in distant bark."""
_TWIG = np.array([0.36, 0.28, 0.22])
_SUN = np.array([-0.35, -0.5, 0.8])
_SUN /= np.linalg.norm(_SUN)
# A leaf with the area of the disc of its cluster, from its stalk on.
_ALONG = np.array([0.8, 0.0, 0.0])
_ACROSS = np.array([0.0, 0.48, 0.0])
_BLADE = np.stack([-_ALONG, _ACROSS, _ALONG, -_ACROSS])
_NEEDLES_WIDTH = 0.4
"""Width of a spray of needles over that of a leaf."""
_WIND, _GHOST, _SHADOW = '#1f6fb4', '#dedad6', '#e2e2e0'

_Limits = tuple[tuple[float, float], tuple[float, float]]
"""Visible part of the picture plane: left and right, bottom and top, in [m]."""


def seen(points: ArrayLike) -> Floats:
    """Right, up and away of points (..., 3), all in [m]."""
    sine = np.sin(ELEVATION)
    cosine = np.cos(ELEVATION)
    right = [1.0, 0.0, 0.0]
    up = [0.0, sine, cosine]
    away = [0.0, cosine, -sine]
    view = np.array([right, up, away])
    return np.asarray(np.asarray(points, dtype=np.float64) @ view.T)


def limits_around(points: Floats) -> _Limits:
    """Frame all points [m], (n, 3), with a margin round them and room for the wind above."""
    right, up = seen(points)[:, :2].T
    width = float(np.ptp(right))
    size = max(float(np.ptp(up)), 0.4 * width)
    half_width = max(0.5 * width, 0.3 * size) + _MARGIN * size
    middle = 0.5 * float(right.min() + right.max())
    sides = middle - half_width, middle + half_width
    bottom = float(up.min()) - 0.1 * size
    top = float(up.max()) + 0.16 * size
    return sides, (bottom, top)


def draw_trees(
    axes: Axes,
    trees: Sequence[Tree],
    poses: ArrayLike,
    limits: _Limits,
    *,
    wind: ArrayLike = (0.0, 0.0, 0.0),
    leaves: LeafClusters | None = None,
    flutter: ArrayLike = 0.0,
    has_ghost: bool = False,
) -> None:
    """
    Clear the axes and draw trees.

    Parameters
    ----------
    axes
        Axes to draw on.
    trees, poses
        Trees, and the pose block of all their segments, one tree after the other, (n, 7).
    limits
        Visible part, as in `limits_around`.
    wind
        Wind in [m/s], (3,), shown by an arrow; (0, 0, 0) for no arrow.
    leaves, flutter
        Leaves on these segments, if any, and the angle of each, as in `leaf_poses`.
    has_ghost
        True to draw the shape at rest behind.

    """
    from matplotlib.collections import PolyCollection

    axes.clear()
    axes.axis('off')
    axes.set(xlim=limits[0], ylim=limits[1], aspect='equal')
    _draw_shadows(axes, trees)
    length = np.concatenate([tree.length for tree in trees])
    block = np.asarray(poses, dtype=np.float64)
    if has_ghost:
        rest = np.vstack([tree.rest_poses for tree in trees])
        ghost = _tapered(trees, *ends_of_poses(rest, length))[..., :2]
        axes.add_collection(PolyCollection(ghost, color=_GHOST))  # type: ignore[arg-type]
    shapes = _tapered(trees, *ends_of_poses(block, length))
    colors = np.vstack([_bark(tree) for tree in trees])
    if leaves is not None:
        blades, green = _blades(trees, leaves, leaf_poses(leaves, block, flutter))
        shapes = np.concatenate([shapes, blades])
        colors = np.concatenate([colors, green])
    away = shapes[..., 2].mean(axis=1)
    colors = _hazed(colors, away, limits)
    far_first = np.argsort(-away)
    corners = shapes[far_first, :, :2]
    axes.add_collection(
        PolyCollection(
            corners,  # type: ignore[arg-type]
            facecolors=colors[far_first],
            edgecolors='face',
            linewidths=0.4,
        )
    )
    _draw_wind(axes, np.asarray(wind, dtype=np.float64), limits)


def _draw_shadows(axes: Axes, trees: Sequence[Tree]) -> None:
    """Draw a shadow on the ground under each tree, half as wide as its crown."""
    from matplotlib.collections import EllipseCollection

    widths = [0.5 * float(np.ptp(tree.end[:, 0])) for tree in trees]
    axes.add_collection(
        EllipseCollection(
            widths,
            np.multiply(widths, np.sin(ELEVATION)),
            0.0,
            units='xy',
            offsets=seen([tree.start[0] for tree in trees])[:, :2],
            offset_transform=axes.transData,
            color=_SHADOW,
        )
    )


def _hazed(colors: Floats, away: Floats, limits: _Limits) -> Floats:
    """Whiten the colours (m, 3) of shapes by how far away they are [m], (m,)."""
    bottom, top = limits[1]
    span = max(float(np.ptp(away)), 0.3 * (top - bottom))
    middle = 0.5 * (away.min() + away.max())
    depth = 0.5 + (away - middle) / span
    return np.asarray(colors + _HAZE * depth[:, None] * (1.0 - colors))


def _tapered(trees: Sequence[Tree], start: Floats, end: Floats) -> Floats:
    """Four corners of each segment: right, up and away, (n, 4, 3)."""
    base = seen(start)
    tip = seen(end)
    across = np.cross(tip - base, [0.0, 0.0, 1.0])
    width = np.linalg.norm(across, axis=1)
    across /= np.maximum(width, 1e-12)[:, None]
    base_diameter = np.concatenate([tree.base_diameter for tree in trees])[:, None]
    tip_diameter = np.concatenate([tree.tip_diameter for tree in trees])[:, None]
    below = 0.5 * base_diameter * across
    above = 0.5 * tip_diameter * across
    return np.stack([base - below, base + below, tip + above, tip - above], axis=1)


def _bark(tree: Tree) -> Floats:
    """Colour of each segment, (n, 3): twigs are brown, with any bark of old wood."""
    thickness = tree.base_diameter / (0.2 * tree.base_diameter[0])
    age = np.clip(thickness, 0.0, 1.0)[:, None]
    old_bark = np.array(look_of(tree.species).bark)
    return np.asarray(_SHADE * (_TWIG + age * (old_bark - _TWIG)))


def _blades(trees: Sequence[Tree], leaves: LeafClusters, placed: Floats) -> tuple[Floats, Floats]:
    """Corners of each leaf: right, up and away, (m, 4, 3), and its colour, (m, 3)."""
    from scipy.spatial.transform import Rotation

    last = np.cumsum([tree.n_segments for tree in trees])
    tree_of_leaf = np.searchsorted(last, leaves.segment, side='right')
    are_needles = np.array([leaf_traits(tree.species).are_needles for tree in trees])
    green = np.array([look_of(tree.species).green for tree in trees])
    blade = leaves.size[:, None, None] * _BLADE
    blade[are_needles[tree_of_leaf], :, 1] *= _NEEDLES_WIDTH
    rotation = Rotation.from_quat(placed[:, 3:]).as_matrix()
    corners = placed[:, None, :3] + np.einsum('mij,mkj->mki', rotation, blade)
    # A leaf is translucent: lit from either side.
    light = 0.6 + 0.55 * np.abs(rotation[..., 2] @ _SUN)
    lit = light[:, None] * green[tree_of_leaf]
    return seen(corners), np.clip(lit, 0.0, 1.0)


def _draw_wind(axes: Axes, wind: Floats, limits: _Limits) -> None:
    """Draw an arrow along the wind in the upper left corner, with its speed."""
    speed = float(np.linalg.norm(wind))
    if speed == 0.0:
        return
    (left, _), (bottom, top) = limits
    size = top - bottom
    x = left + 0.14 * size
    y = top - 0.1 * size
    right, up, _ = (0.08 * size * seen(wind) / speed).tolist()
    arrow = {'arrowstyle': '-|>', 'color': _WIND, 'lw': 1.6, 'shrinkA': 0.0, 'shrinkB': 0.0}
    axes.annotate('', (x + right, y + up), (x - right, y - up), arrowprops=arrow)
    axes.text(x, y + 0.03 * size, f'{speed:.1f} m/s', color=_WIND, ha='center', va='bottom')
