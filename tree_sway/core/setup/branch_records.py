# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
How the branches of a tree are joined and drawn (`places_of`), and what the wind does to each.

`branch_records` fits the drag on all pieces of a branch by a few numbers: the centre of the load,
the projector across the branch, and the mean displacements that the load works on and damps.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from tree_sway.core.arrays import Floats, Ints, Records
from tree_sway.core.beams.beam import cross, cross_matrix, stacked
from tree_sway.core.beams.branch_model import BranchModel
from tree_sway.core.beams.shape_fields import across
from tree_sway.core.beams.wind_on_branch import exposure
from tree_sway.core.model.fill_records import fill_places, Places
from tree_sway.core.model.records import branch_layout, room_for_fields
from tree_sway.core.rotation import rotated
from tree_sway.core.setup.matrices import Reduction
from tree_sway.core.tree.tree import Tree

_rotated = rotated.py_func  # type: ignore[attr-defined]  # whole arrays at once


def places_of(tree: Tree, models: list[BranchModel], reduction: Reduction) -> Places:
    """Find how the modelled branches of a tree are joined and drawn."""
    first, size = tree.branch_first[:-1], np.diff(tree.branch_first)
    on = tree.segment_parent[first]
    following = tree.end.copy()
    within = np.ones(tree.n_segments, dtype=bool)
    within[tree.branch_first[1:] - 1] = False
    following[within] = tree.start[1:][within[:-1]]
    w, x, y, z = tree.rest_frame[on].T
    offset = np.stack(_rotated(w, -x, -y, -z, *(tree.start[first] - tree.start[on]).T), axis=1)
    slope, tip_slope = _slopes(tree, models)
    share, skews = tree.length / np.repeat(np.add.reduceat(tree.length, first), size), []
    for each in (slope, tip_slope):
        deviation = each - np.repeat(np.add.reduceat(share * each, first), size)
        # The third cumulant over 6: the lag of the chord angle, per angle cubed.
        skews.append(np.add.reduceat(share * deviation**3, first) / 6.0)
    counts = np.array([len(model.fields) for model in models])
    rotation_mode = np.zeros((tree.n_segments, room_for_fields(counts.max()), 3))
    chord = np.array([model.beam.chord for model in models])
    e1, e2 = across(chord)
    # A plain branch rotates by one slope about the axes across its chord.
    drawn = np.stack([e2, -e1], axis=1)[tree.branch_of_segment]
    rotation_mode[:, :2] = slope[:, None, None] * drawn
    for branch in np.flatnonzero(counts > 2).tolist():
        modes = [models[branch].beam.over_segments(one.slope) for one in models[branch].fields]
        rotation_mode[tree.segments_of(branch), : len(modes)] = np.stack(modes, axis=1)
    return Places(
        tree.branch_first, tree.branch_parent, on, reduction.first[:-1], counts,
        np.stack([chord, e1, e2], axis=1), skews[0], skews[1],
        np.where(on[:, None] >= 0, offset, 0.0), reduction.twist[:, :, 3:],
        following - tree.start, tree.rest_frame, slope, tip_slope, rotation_mode,
    )  # fmt: skip


def branch_records(
    tree: Tree, models: list[BranchModel], reduction: Reduction, places: Places,
    speed_profile: Floats,
) -> Records:  # fmt: skip
    """
    Fill the branches for stepping and placing: records of `branch_layout`, (b,).

    The profile is the wind speed at each segment over that at the anemometer, (n,).
    """
    records = np.zeros(tree.n_branches, dtype=branch_layout(places.rotation_mode.shape[1]))
    alike: dict[tuple[int, int, bool], list[int]] = {}
    for branch, model in enumerate(models):
        kind = len(model.beam.length), len(model.fields), len(model.children) > 0
        alike.setdefault(kind, []).append(branch)
    for branches in alike.values():
        _fill_loads([models[branch] for branch in branches], speed_profile[
            np.array([tree.branch_first[b] + models[b].beam.segment for b in branches])
        ], np.array(branches), records)  # fmt: skip
    fill_places(places, records)
    records['twist'] = reduction.twist[:, : records['twist'].shape[1]]
    records['tip'] = tree.end[tree.branch_first[1:] - 1] - tree.start[0]
    base = tree.start[tree.branch_first[:-1]] - tree.start[0]
    arm = base - base[np.maximum(tree.branch_parent, 0)]
    square = np.square(arm).sum(axis=1)
    records['base'], records['arm'] = base, arm
    records['per_arm'] = np.divide(0.5, square, out=np.zeros_like(square), where=square > 0.0)
    return records


_STRAIGHT = 0.03
"""Smallest share of the wind along a branch that is distinguished from 0."""

_CROOKED = 1e-9
"""Largest deviation of the cosine between panels from 1 of a branch that is straight."""


class _Panels(NamedTuple):
    """Panels of k branches that all have p panels, g points in each, and n fields."""

    point: Floats
    """Points from the base, (k, p, g, 3)."""
    tangent: Floats
    """Direction of each panel, (k, p, 3)."""
    area: Floats
    """Drag area of each branch in [m^2], (k,)."""
    share: Floats
    """Fraction of that area at each point, (k, p, g)."""
    displacement: Floats
    """Displacement of each point per unit of each coordinate, (k, n, p, g, 3)."""
    rotation: Floats
    """Rotation vector there, likewise."""
    tip: Floats
    """Displacement of the tip, (k, n, 3)."""


def _panels_of(models: list[BranchModel]) -> _Panels:
    """Stack the panels of branches."""
    beams = [model.beam for model in models]
    weight = np.array([model.drag_area for model in models]) * stacked(beams, 'weight')
    alike = list(zip(*(model.fields for model in models), strict=True))
    displacement, rotation, nodes = (
        np.stack([stacked(each, name) for each in alike], axis=1)
        for name in ('points', 'slope', 'nodes')
    )
    area = weight.sum(axis=(1, 2))
    share = weight / area[:, None, None]
    point, tangent = stacked(beams, 'point'), stacked(beams, 'tangent')
    return _Panels(point, tangent, area, share, displacement, rotation, nodes[:, :, -1])


def _fill_loads(
    models: list[BranchModel], speed_profile: Floats, rows: Ints, records: Records
) -> None:
    """
    Fill the fields of the wind load of branches that all have p panels and n fields.

    The speed profile is the wind speed at their panels over that at the anemometer, (k, p).
    """
    panels = _panels_of(models)
    records['tip_mode'][rows, : panels.tip.shape[1]] = panels.tip
    _fill_area(panels, speed_profile, rows, records)
    projector = _fill_projector(panels, rows, records)
    mean = _mean_across(panels)
    records['load_mode'][rows, : mean.shape[1]] = mean @ _inverse_of(projector)
    moved = _squares_across(panels)
    _fill_load_rotation(panels, moved, rows, records)
    off_line = (panels.tangent * panels.tangent[:, :1]).sum(axis=2) - 1.0
    for k in np.flatnonzero(np.abs(off_line).max(axis=1) > _CROOKED):
        _fit_load(models[k], panels.share[k], records[rows[k]])
    # As if both axes were alike.
    cubes = 2.0 * np.maximum(0.5 * moved, 0.0) ** 1.5
    square, cube = ((panels.share * each).sum(axis=(1, 2)) for each in (moved, cubes))
    _fill_damping(records, rows, mean, square, cube)


def _fill_area(panels: _Panels, speed_profile: Floats, rows: Ints, records: Records) -> None:
    """Fill where the wind acts on branches, its speed there, and on how much area."""
    centre = np.einsum('ksg,ksgi->ki', panels.share, panels.point)
    records['centre'][rows] = centre
    records['coupling'][rows] = cross_matrix(centre)
    speed = (panels.share.sum(axis=2) * speed_profile).sum(axis=1)
    records['speed'][rows] = speed
    has_wind = speed > 0.0
    area = np.divide(panels.area, speed**2, out=np.zeros_like(speed), where=has_wind)
    records['area'][rows] = area


def _fill_projector(panels: _Panels, rows: Ints, records: Records) -> Floats:
    """Fill the mean of ``1 - t t^T`` over the panels, tangents t; return it, (k, 3, 3)."""
    weighted = panels.share.sum(axis=2)[:, None] * panels.tangent.swapaxes(1, 2)
    projector = np.eye(3) - weighted @ panels.tangent
    first, second = [0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]  # xx, yy, zz, xy, xz, yz
    records['projector'][rows] = projector[:, first, second]
    return np.asarray(projector)


def _inverse_of(projector: Floats) -> Floats:
    """
    Invert projectors (k, 3, 3) across the branches.

    The wind along a straight branch exerts no force on it, and that direction is left out.
    """
    amounts, axes = np.linalg.eigh(projector)
    stored = amounts > _STRAIGHT * amounts[:, -1:]
    amounts = np.divide(1.0, amounts, out=np.zeros_like(amounts), where=stored)
    return np.asarray((axes * amounts[:, None]) @ axes.swapaxes(1, 2))


def _mean_across(panels: _Panels) -> Floats:
    """Find the mean displacement across the panels, weighted by their exposure, (k, n, 3)."""
    tangent = panels.tangent[:, None]
    exposed = exposure(panels.tangent)
    exposed /= (panels.share.sum(axis=2) * exposed).sum(axis=1, keepdims=True)
    mean = (panels.share[:, None, ..., None] * panels.displacement).sum(axis=3)
    mean = exposed[:, None, :, None] * mean
    mean -= (mean * tangent).sum(axis=-1, keepdims=True) * tangent
    return np.asarray(mean.sum(axis=2))


def _squares_across(panels: _Panels) -> Floats:
    """Sum the squared displacements of points across their panels by both axes, (k, p, g)."""
    by_axes = panels.displacement[:, :2]
    along = (by_axes * panels.tangent[:, None, :, None]).sum(axis=-1)
    return np.asarray((np.square(by_axes).sum(axis=-1) - np.square(along)).sum(axis=1))


def _fill_load_rotation(panels: _Panels, moved: Floats, rows: Ints, records: Records) -> None:
    """Fill the mean rotation: pieces that move most do most work, and are rotated most."""
    work = (panels.share * np.sqrt(np.maximum(moved, 0.0))).reshape(len(rows), 1, 1, -1)
    whole = work.sum(axis=-1, keepdims=True)
    work /= np.where(whole > 0.0, whole, 1.0)
    n = panels.rotation.shape[1]
    rotation = panels.rotation.reshape(len(rows), n, -1, 3)
    records['load_rotation'][rows, :n] = (work @ rotation)[:, :, 0]


def _fit_load(model: BranchModel, share: Floats, record: np.void) -> None:
    """Fit projector, load mode and coupling of a crooked branch to its drag (least squares)."""
    tangent = model.beam.tangent
    slanting = _SlantingWinds(model.beam.chord)
    outer = (np.eye(3) - tangent[:, :, None] * tangent[:, None, :]).reshape(-1, 9)
    drag = slanting.squares(outer[:, [0, 4, 8, 1, 2, 5]]) ** 1.5 @ share.sum(axis=1)
    record['projector'] = slanting.nearest(drag ** (2.0 / 3.0))
    projector = record['projector'][[0, 3, 4, 3, 1, 5, 4, 5, 2]].reshape(3, 3)
    across = slanting.winds @ projector
    force = np.sqrt(np.maximum((slanting.winds * across).sum(axis=1), 0.0))[:, None] * across
    fit = np.linalg.pinv(force, rcond=_STRAIGHT)
    pieces = slanting.winds[:, None] - (slanting.winds @ tangent.T)[..., None] * tangent
    pieces *= np.linalg.norm(pieces, axis=-1, keepdims=True)
    point = (share[..., None] * model.beam.point).sum(axis=1)
    moment = cross(point, pieces).sum(axis=1)
    record['coupling'] += (fit @ (moment - force @ record['coupling'].T)).T
    k = len(model.fields)
    moved = np.stack([(share[..., None] * one.points).sum(axis=1) for one in model.fields])
    pushed = np.einsum('dsk,csk->dc', pieces, moved)
    record['load_mode'][:k] += (fit @ (pushed - force @ record['load_mode'][:k].T)).T


def _fill_damping(
    records: Records, rows: Ints, mean: Floats, square: Floats, cube: Floats
) -> None:
    """
    Scale the mean displacement to the one whose drag damping is that of the mean square.

    Both axes of the first shape count as one, so that it does not matter how they are laid.

    In wind its damping is that of the pieces. In still air that is the mean cube of their speed:
    the spread is the missing part of the speed of mean cube over mean square.
    """
    across = np.square(mean[:, :2]).sum(axis=(1, 2))
    ratio = np.divide(square, across, out=np.ones_like(square), where=across > 0.0)
    mean[:, :2] *= ratio[:, None, None]
    still = np.divide(cube, square, out=np.zeros_like(square), where=square > 0.0) ** 2
    records['damping_mode'][rows, : mean.shape[1]] = mean
    records['spread'][rows] = np.maximum(still - 0.5 * ratio**2 * across, 0.0)
    records['lever'][rows] = np.sqrt(0.5 * across)


class _SlantingWinds:
    """
    Winds from all sides, horizontal and, as branches bend, oblique.

    The first one follows a direction (3,), so that a rotated tree has the load of the rotated
    wind.
    """

    def __init__(self, direction: Floats) -> None:
        """Make winds of 16 bearings at each of three elevations."""
        x, y, _ = direction
        points = math.hypot(x, y) > 1e-6 * float(np.linalg.norm(direction))
        bearing = (math.atan2(y, x) if points else 0.0) + np.arange(16) * np.pi / 8.0
        rise = np.radians([-10.0, 0.0, 10.0])[:, None]
        level, up = np.cos(rise), np.broadcast_to(np.sin(rise), (3, 16))
        winds = np.stack([level * np.cos(bearing), level * np.sin(bearing), up], axis=2)
        self.winds = winds.reshape(48, 3)
        x, y, z = self.winds.T
        weights = [x * x, y * y, z * z, 2.0 * x * y, 2.0 * x * z, 2.0 * y * z]
        self._weights = np.stack(weights, axis=1)

    def squares(self, projectors: Floats) -> Floats:
        """Return ``u . P u`` of projectors (k, 6) in each wind u, (48, k)."""
        return np.asarray(np.maximum(self._weights @ projectors.T, 0.0))

    def nearest(self, squares: Floats) -> Floats:
        """Return the projector (6,) that fits these squares, (48,), best."""
        return np.asarray(np.linalg.lstsq(self._weights, squares, rcond=None)[0])


def _slopes(tree: Tree, models: list[BranchModel]) -> tuple[Floats, Floats]:
    """
    Slope of each segment of a plain branch, and under a load at the tip, both (n,).

    The latter is the mean over the segment of 1.5 (2 u - u^2), u the arc length over the length.
    """
    first, size = tree.branch_first[:-1], np.diff(tree.branch_first)
    whole = np.repeat(np.add.reduceat(tree.length, first), size)
    slope = np.concatenate([model.shape.segment_slope for model in models])
    mean = np.repeat(np.add.reduceat(slope * tree.length, first), size) / whole
    past = np.cumsum(tree.length)
    end = (past - np.repeat(past[first] - tree.length[first], size)) / whole
    start = end - tree.length / whole
    steepness = end + start - (end * end + end * start + start * start) / 3.0
    return slope, 1.5 * mean * steepness
