# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Where a motion sensor sits on a tree, and how each coordinate of a model moves that place.

A place is written as a height on the stem in [m] (``3.2``), as a branch and a share of its length
(``b12:0.5``), or as a segment (``segment:431``). The bearing to which the z axis of the sensor
points, the back of a phone's being the tree, may follow: ``3.2 facing 120``.

A pair of strain gauges, on the north and the east side of the wood, is a sensor too: ``1.3
strain``. What it measures, curvature times radius, is passed on as the rotation of a place, a
strain of 1 as one by `_PER_STRAIN`; ``facing`` is then the bearing of the side of the first gauge.
"""

from __future__ import annotations

from collections.abc import Callable
import math
from typing import NamedTuple, TYPE_CHECKING

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.checks import within
from tree_sway.core.rotation import cross
from tree_sway.core.tree import ends_of_poses, tips_of_poses, Tree
from tree_sway.errors import nearest, ParameterError

if TYPE_CHECKING:
    from tree_sway.core.run import SwaySimulator

_PER_STRAIN = 100.0
"""Rotation [rad] in place of a strain: the least noise of a rotation is a strain of 2e-5."""

_TURN = 1e-4
"""Largest key rotation in [rad] of the difference quotients."""


class SensorPlace(NamedTuple):
    """
    A segment, and a share of its length from its root side.

    ``facing`` is the azimuth to which the z axis of the sensor points, or its y axis where that is
    upright, from east to north in [rad]; None if it is not told. ``is_strain`` is whether it
    measures strain.
    """

    segment: int
    along: float
    facing: float | None = None
    is_strain: bool = False


class PlaceMotion(NamedTuple):
    """Displacement [m] and rotation [rad] of a place per unit of each coordinate, (3, m)."""

    displacement: Floats
    rotation: Floats

    def first(self, count: int) -> PlaceMotion:
        """Return those of the first coordinates alone, (3, count)."""
        return PlaceMotion(self.displacement[:, :count], self.rotation[:, :count])


def place_on(tree: Tree, where: str | float) -> SensorPlace:
    """
    Find a place on a tree.

    Parameters
    ----------
    tree
        The tree.
    where
        Height above the root node on the stem in [m], ``BRANCH:SHARE`` or ``segment:NUMBER``, with
        the bearing to which the sensor faces behind it if that is known: ``3.2 facing 120``, or
        ``3.2 facing SE``.

    Raises
    ------
    ParameterError
        A text of another form, an unknown branch or segment, or a height above the stem.

    """
    text, is_told, bearing = str(where).strip().partition(' facing')
    if is_told:
        degrees = _POINTS.get(bearing.strip().upper(), _number(bearing))
        bearing_to = within('facing', degrees, -360.0, 360.0, 'degrees')
        return place_on(tree, text)._replace(facing=math.radians(90.0 - bearing_to))
    if text.endswith(' strain'):
        at = place_on(tree, text.removesuffix(' strain'))._replace(is_strain=True)
        _joint(tree, at)
        return at
    name, colon, number = text.rpartition(':')
    value = _number(number)
    if not math.isfinite(value):
        cure = "give a height on the stem in m, as '3.2', or a branch and a share, as 'b12:0.5'"
        raise ParameterError(f"'{text[:40]}' is no place on a tree", where='at', cure=cure)
    if not colon:
        return _on_stem(tree, value)
    if name == 'segment':
        if not (value.is_integer() and 0 <= value < tree.n_segments):
            cure = f'give segment:0 to segment:{tree.n_segments - 1}'
            raise ParameterError(f"no segment '{number}'", where='at', cure=cure)
        return SensorPlace(int(value), 0.5)
    if name not in tree.branch_names:
        cure = nearest(name, tree.branch_names) or f'such as {tree.branch_names[0]}:0.5'
        raise ParameterError(f"no branch '{name}'", where='at', cure=cure)
    if not 0.0 <= value <= 1.0:
        cure = 'give a share of its length from 0 at its base to 1 at its tip'
        raise ParameterError(f'{value:g} of a branch', where='at', cure=cure)
    branch = tree.branch_names.index(name)
    first, last = tree.branch_first[branch], tree.branch_first[branch + 1]
    ends = np.cumsum(tree.length[first:last])
    return _along(int(first), ends, value * ends[-1])


def reach_of(tree: Tree, place: SensorPlace) -> tuple[float, float]:
    """Way to a place from the middle of the branches in the wind, at rest, east and north [m]."""
    area = tree.length * (tree.base_diameter + tree.tip_diameter)
    middle = np.average(0.5 * (tree.start + tree.end), axis=0, weights=area)
    east, north, _ = (point_at(tree, place) - middle).tolist()
    return east, north


def point_at(tree: Tree, place: SensorPlace) -> Floats:
    """Point of a place at rest in [m], (3,)."""
    start, end = tree.start[place.segment], tree.end[place.segment]
    return start + place.along * (end - start)


_POINTS = {name: 45.0 * number for number, name in enumerate('N NE E SE S SW W NW'.split())}
"""Degrees of the points of the compass."""


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        return math.nan


def _on_stem(tree: Tree, height: float) -> SensorPlace:
    """Return the lowest place of the stem at a height above the root node in [m]."""
    last = tree.branch_first[1]
    tops = np.maximum.accumulate(tree.end[:last, 2]) - tree.start[0, 2]
    if not 0.0 <= height <= tops[-1]:
        cure = f'give 0 to {tops[-1]:.3g} m, or a branch and a share, as '
        cure += f"'{tree.branch_names[-1]}:0.5'"
        raise ParameterError(f'the stem has no height of {height:g} m', where='at', cure=cure)
    return _along(0, np.maximum(tops, 1e-12 * np.arange(1, last + 1)), height)


def _along(first: int, ends: Floats, at: float) -> SensorPlace:
    """Return the place at a length, or height, of segments from a first one on."""
    row = min(int(np.searchsorted(ends, at)), len(ends) - 1)
    before = ends[row - 1] if row else 0.0
    share = (at - before) / max(ends[row] - before, 1e-12)
    return SensorPlace(first + row, min(max(share, 0.0), 1.0))


def slopes_at_rest(
    simulator: SwaySimulator,
    read: Callable[[Floats], Floats],
    change: Callable[[Floats, Floats], Floats] = np.subtract,
) -> Floats:
    """
    Differentiate what poses tell by each coordinate of a simulator, at rest, (..., m).

    Parameters
    ----------
    simulator
        The simulator.
    read
        Reads an array (...) from the poses of segments (n, 7).
    change
        Finds the change from a second array to a first one.

    """
    shapes = simulator.banks[0].oscillators.shapes
    poses = np.zeros((simulator.tree.n_segments, 7))
    slopes = []
    for shape in shapes.T:
        amount = _TURN / max(np.abs(shape).max(), 1e-300)
        turned = np.ascontiguousarray(amount * shape)
        ahead, behind = (
            read(simulator.place_rotations(each, poses)).copy() for each in (turned, -turned)
        )
        slopes.append(change(ahead, behind) / (2.0 * amount))
    return np.stack(slopes, axis=-1)


def place_motion(simulator: SwaySimulator, place: SensorPlace) -> PlaceMotion:
    """
    Differentiate the pose of a place by each coordinate of a simulator, at rest.

    The rotation is a rotation vector in the frame of the tree, and so is the displacement. Of a
    place of strain it is `bend_at`.
    """
    tree, at = simulator.tree, place.segment
    if place.is_strain:
        bent = slopes_at_rest(simulator, lambda poses: bend_at(tree, poses, place))
        return PlaceMotion(np.zeros_like(bent), bent)
    away = np.array([place.along * tree.length[at]])
    return PlaceMotion(
        slopes_at_rest(simulator, lambda poses: ends_of_poses(poses[at : at + 1], away)[1][0]),
        slopes_at_rest(
            simulator,
            lambda poses: poses[at, 3:],
            lambda ahead, behind: turn_between(behind, ahead),
        ),
    )


def _joint(tree: Tree, place: SensorPlace) -> int:
    """Return the segment below the joint of its branch that is nearest to a place."""
    branch = tree.branch_of_segment[place.segment]
    first, last = tree.branch_first[branch], tree.branch_first[branch + 1]
    if last - first < 2:
        cure = 'give a branch of two segments or more'
        raise ParameterError('strain of a branch of one segment', where='at', cure=cure)
    return min(max(place.segment - (place.along < 0.5), first), last - 2)


def bend_at(tree: Tree, poses: Floats, place: SensorPlace) -> Floats:
    """
    Return curvature times radius at a place by the poses of segments (n, 7), times `_PER_STRAIN`.

    It is a vector about which the wood is bent, in the frame of the tree, (3,), by the turn from
    segment to segment at the nearest joint; from there on the moment is taken to be the same.
    """
    below = _joint(tree, place)
    turn = turn_between(poses[below, 3:], poses[below + 1, 3:])
    span = 0.5 * (tree.length[below] + tree.length[below + 1])
    low, high = (each[place.segment] for each in (tree.base_diameter, tree.tip_diameter))
    here = low + place.along * (high - low)
    joint = 0.5 * (tree.tip_diameter[below] + tree.base_diameter[below + 1])
    return _PER_STRAIN * 0.5 * here * (joint / here) ** 4 * turn / span


def strain_of(bent: Floats) -> Floats:
    """Strain on the north and the east side [-], (..., 2), by `bend_at`; tension is positive."""
    return np.stack([bent[..., 0], -bent[..., 1]], axis=-1) / _PER_STRAIN


def as_orientation(strain: Floats) -> Floats:
    """Return strains on the north and east side (n, 2) as orientations x y z w, (n, 4)."""
    half = (
        0.5 * _PER_STRAIN * np.column_stack([strain[:, 0], -strain[:, 1], np.zeros(len(strain))])
    )
    size = np.linalg.norm(half, axis=1)
    return np.column_stack([half * np.sinc(size / np.pi)[:, None], np.cos(size)])


def tip_slopes(simulator: SwaySimulator) -> Floats:
    """Differentiate the tips of branches by each coordinate, at rest, (b, 3, m)."""
    return slopes_at_rest(simulator, lambda poses: tips_of_poses(simulator.tree, poses))


def turn_between(before: Floats, after: Floats) -> Floats:
    """
    Rotation vectors from quaternions to others, both (..., 4) as x y z w, in [rad], (..., 3).

    They are in the frame in which both quaternions are given.
    """
    a, b = after[..., :3], before[..., :3]
    wa, wb = after[..., 3:], before[..., 3:]
    vector = wb * a - wa * b - cross(a, b)
    scalar = wa * wb + (a * b).sum(axis=-1, keepdims=True)
    vector = np.where(scalar < 0.0, -vector, vector)
    sine = np.linalg.norm(vector, axis=-1, keepdims=True)
    angle = 2.0 * np.arctan2(sine, np.abs(scalar))
    return vector * np.where(sine > 1e-9, angle / np.maximum(sine, 1e-9), 2.0)
