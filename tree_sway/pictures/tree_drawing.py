# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A tree on matplotlib axes: bark thick as it is, far branches paler, leaves if there are any."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.tree.species import bark_color, species_keys, species_named
from tree_sway.core.tree.tree import Tree
from tree_sway.pictures.leaf_drawing import leaf_blades, leaf_colors
from tree_sway.pictures.projection import Camera

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_SHADE, _HAZE = 0.68, 0.62
"""Near bark is so much darker than bark in the sun; far bark fades by so much to white."""
_TWIG = np.array([0.36, 0.28, 0.22])
_THICK = 0.004
"""Diameter over the height of the picture from which joints are closed by discs."""
_FLARE, _FLARE_HIGH = 0.45, 1.6
"""How much wider a stem is at the ground, and how high that goes, in diameters."""
_POT = '#b5694a'
_POT_RIM = '#c67f60'
_GROUND = '#8d8d86'
_GHOST = '#dedad6'


@dataclass(frozen=True)
class Frame:
    """What part of the picture plane is shown: its limits in [m]."""

    left: float
    right: float
    bottom: float
    top: float

    @property
    def aspect(self) -> float:
        """Width over height."""
        return (self.right - self.left) / (self.top - self.bottom)


def frame_around(
    points: Floats, camera: Camera, margin: float = 0.06, headroom: float = 0.0
) -> Frame:
    """
    Frame all points [m], (..., 3), with a margin round them and headroom above.

    Both are over its height, or over what is much wider than high.
    """
    seen = camera.project(points).reshape(-1, 3)
    low, high = seen[:, :2].min(axis=0), seen[:, :2].max(axis=0)
    size = max(float(high[1] - low[1]), 0.4 * float(high[0] - low[0]))
    middle = 0.5 * float(low[0] + high[0])
    half = max(0.5 * float(high[0] - low[0]), 0.3 * size) + margin * size
    top = float(high[1]) + (margin + headroom) * size
    return Frame(middle - half, middle + half, float(low[1]) - 0.14 * size, top)


def draw_tree(
    axes: Axes,
    tree: Tree,
    start: Floats,
    end: Floats,
    camera: Camera,
    frame: Frame,
    leaves: tuple[Floats, Floats] | None = None,
) -> None:
    """
    Draw a tree, at rest or deflected, on axes whose limits are set to the frame.

    Parameters
    ----------
    axes, camera, frame
        Where to draw, from where it is seen, and what is shown of it.
    tree, start, end
        The tree, and the nodes of its segments as they are now in [m], (n, 3) each.
    leaves
        Pose block of the leaf clusters, (m, 7), and their diameters in [m], (m,).

    """
    from matplotlib.collections import PolyCollection
    from matplotlib.patches import Ellipse, Polygon

    axes.set(xlim=(frame.left, frame.right), ylim=(frame.bottom, frame.top), aspect='equal')
    axes.axis('off')
    pot, (middle, width, height) = ground_shapes(tree, camera)
    for corners, color in pot:
        axes.add_patch(Polygon(corners, color=color, lw=0, zorder=0))
    if not pot:
        axes.add_patch(Ellipse(middle, width, height, color=_GROUND, alpha=0.25, lw=0, zorder=0))
    polygons, colors, edges = painted_shapes(tree, start, end, camera, frame, leaves)
    drawn = PolyCollection(polygons, facecolors=colors, edgecolors=colors, linewidths=edges)
    drawn.set_joinstyle('round')
    axes.add_collection(drawn)


def painted_shapes(
    tree: Tree,
    start: Floats,
    end: Floats,
    camera: Camera,
    frame: Frame,
    leaves: tuple[Floats, Floats] | None = None,
) -> tuple[list[Floats], Floats, Floats]:
    """
    Shapes of a tree on the picture plane, the far ones first; arguments as of `draw_tree`.

    Returns
    -------
    tuple
        Corners of each shape in [m], (k, 2); colours (s, 3), 0 to 1; widths of edges in [pt],
        (s,).

    """
    base, tip = camera.project(start), camera.project(end)
    depth = _depth(camera, 0.5 * (start + end), frame)
    polygons = list(_tapered(base, tip, tree.base_diameter, tree.tip_diameter))
    # Twigs are brown, whatever the colour of the bark that old wood has.
    old = np.clip(tree.base_diameter / (0.2 * tree.base_diameter[0]), 0.0, 1.0)[:, None]
    near = _SHADE * (_TWIG + old * (np.array(bark_color(tree.species)) - _TWIG))
    colors = near + _HAZE * depth[:, None] * (1.0 - near)
    away = 0.5 * (base[:, 2] + tip[:, 2])
    # Discs close the joints of thick wood, edges in the same colour those of the rest.
    thick = np.flatnonzero(tree.base_diameter > _THICK * (frame.top - frame.bottom))
    polygons += list(_discs(base[thick, :2], tree.base_diameter[thick]))
    if len(thick) and not _is_potted(tree):
        polygons.append(_flare(base[0, :2], float(tree.base_diameter[0])))
        thick = np.append(thick, 0)
    colors, away = np.vstack([colors, colors[thick]]), np.append(away, away[thick])
    edges = np.full(len(away), 0.45)
    if leaves is not None and len(leaves[1]):
        corners, normal = leaf_blades(tree.species, *leaves)
        seen = camera.project(corners)
        depth = _depth(camera, corners.mean(axis=1), frame)
        polygons += list(seen[..., :2])
        colors = np.vstack([colors, leaf_colors(tree.species, normal, depth, camera)])
        away = np.concatenate([away, seen[..., 2].mean(axis=1)])
        edges = np.concatenate([edges, np.full(len(seen), 0.1)])
    far_first = np.argsort(-away)
    return [polygons[i] for i in far_first], colors[far_first], edges[far_first]


def draw_ghost(axes: Axes, tree: Tree, camera: Camera) -> None:
    """Draw the tree at rest as a pale shape behind what is drawn, to see how far it moved."""
    from matplotlib.collections import PolyCollection

    base, tip = camera.project(tree.start), camera.project(tree.end)
    shape = list(_tapered(base, tip, tree.base_diameter, tree.tip_diameter))
    axes.add_collection(
        PolyCollection(shape, facecolors=_GHOST, edgecolors=_GHOST, linewidths=0.6, zorder=0.5)
    )


def draw_scale(axes: Axes, frame: Frame) -> None:
    """Draw a bar of a round length in the lower right corner."""
    size = frame.top - frame.bottom
    length = max(
        v for v in (0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 0.02) if v <= max(0.2 * size, 0.02)
    )
    right, low = frame.right - 0.03 * size, frame.bottom + 0.045 * size
    axes.plot([right - length, right], [low, low], color='black', lw=1.6, solid_capstyle='butt')
    axes.text(right - 0.5 * length, low + 0.012 * size, f'{length:g} m', ha='center', va='bottom')


def draw_wind(axes: Axes, frame: Frame, camera: Camera, wind: Floats) -> None:
    """Draw an arrow along the wind (3,) in [m/s] as the camera sees it, with its speed."""
    size, speed = frame.top - frame.bottom, float(np.linalg.norm(wind))
    if speed == 0.0:
        return
    along = camera.project(wind)[:2] / speed
    length = 0.16 * size
    middle = np.array([frame.left + 0.14 * size, frame.top - 0.09 * size])
    base, tip = middle - 0.5 * length * along, middle + 0.5 * length * along
    arrow = {'arrowstyle': '-|>,head_width=.35,head_length=.7', 'lw': 2.2, 'color': '#1f6fb4'}
    axes.annotate('', xy=tuple(tip), xytext=tuple(base), arrowprops=arrow)
    axes.text(
        middle[0], middle[1] + 0.025 * size, f'{speed:.1f} m/s', ha='center', color='#1f6fb4'
    )


def _tapered(base: Floats, tip: Floats, base_diameter: Floats, tip_diameter: Floats) -> Floats:
    """Four corners of each segment on the picture plane, (n, 4, 2)."""
    along = tip[:, :2] - base[:, :2]
    across = np.stack([-along[:, 1], along[:, 0]], axis=1)
    across /= np.maximum(np.linalg.norm(across, axis=1), 1e-12)[:, None]
    at_base, at_tip = 0.5 * base_diameter[:, None] * across, 0.5 * tip_diameter[:, None] * across
    a, b = base[:, :2], tip[:, :2]
    return np.stack([a - at_base, a + at_base, b + at_tip, b - at_tip], axis=1)


def _discs(middle: Floats, diameter: Floats) -> Floats:
    """Twelve corners of a disc at each point of the picture plane, (n, 12, 2)."""
    angle = np.arange(12) * np.pi / 6.0
    round_it = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    return np.asarray(middle[:, None] + 0.5 * diameter[:, None, None] * round_it)


def _flare(foot: Floats, diameter: float) -> Floats:
    """Outline of the root flare round the foot of a stem on the picture plane, (k, 2)."""
    up = np.linspace(0.0, 1.0, 8)
    half = 0.5 * diameter * (1.0 + _FLARE * (1.0 - up) ** 2.5)
    high = _FLARE_HIGH * diameter * up
    left, right = np.stack([-half, high], axis=1), np.stack([half, high], axis=1)
    return np.asarray(foot + np.vstack([left, right[::-1]]))


def _is_potted(tree: Tree) -> bool:
    return tree.species in species_keys() and species_named(tree.species).habit == 'pot'


def _depth(camera: Camera, points: Floats, frame: Frame) -> Floats:
    """How far back each point stands, from 0 to 1; little in a tree that has no depth."""
    away = camera.distance(points)
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
