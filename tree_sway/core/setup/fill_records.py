# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Filling of the records for stepping and placing a tree.

`Places` has how a tree is joined and drawn, which suffices to place it, as for a receiver of the
stream. `branch_records` adds the wind load; `block_records` and `load_records` lay the data out in
slots.
"""

from __future__ import annotations

from heapq import heappop, heappush
import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.arrays import Floats, Ints, Records
from tree_sway.core.beams.beam import cross, cross_matrix, stacked
from tree_sway.core.beams.branch_model import BranchModel
from tree_sway.core.beams.shape_functions import across, exposure
from tree_sway.core.model.records import (
    block_layout,
    branch_layout,
    load_layout,
    room_for_fields,
    segment_layout,
    WIDTH,
    zeros_in_lines,
)
from tree_sway.core.rotation import rotated
from tree_sway.core.setup.matrices import Reduction
from tree_sway.core.tree.tree import Tree


class Places(NamedTuple):
    """
    How branches are joined and drawn: the data for placing a tree, before it is laid out.

    Branches (b,) and segments (n,) are in the order of the tree; k is the largest number of
    coordinates of a branch.
    """

    first: Ints
    """First segment of each branch, and one past the last of all, (b + 1,)."""
    parent: Ints
    base_segment: Ints
    coordinate: Ints
    n_coordinates: Ints
    frame: Floats
    """Chord and the two axes across it, (b, 3, 3)."""
    skew: Floats
    tip_skew: Floats
    offset: Floats
    """Base from the start of the base segment, in the frame of that segment, (b, 3)."""
    base_rotation: Floats
    """Rotation of the base per unit of the parent's coordinates, (b, k, 3)."""
    chord: Floats
    rest: Floats
    slope: Floats
    tip_slope: Floats
    rotation_mode: Floats
    """Rotation vector of each segment per unit of its branch's coordinates, (n, k, 3)."""


def segment_records(places: Places) -> Records:
    """Fill the segments for placing: records of `segment_layout`, in blocks."""
    block, slot, n_records = assign_slots(places.first, places.parent, places.n_coordinates)
    is_plain = places.rotation_mode.shape[1] == 2
    records = zeros_in_lines(n_records, segment_layout(places.rotation_mode.shape[1]))
    records['rest'][:, 0] = 1.0
    size = np.diff(places.first)
    rows = np.arange(len(places.slope)) + np.repeat(block - places.first[:-1], size)
    own = np.repeat(slot, size)
    records['chord'][rows, :, own] = places.chord
    records['rest'][rows, :, own] = places.rest
    records['slope'][rows, own], records['tip_slope'][rows, own] = places.slope, places.tip_slope
    np.maximum.at(records['n_slots'], rows, own + 1)
    if not is_plain:
        n_modes = places.rotation_mode.shape[1]
        records['rotation_mode'][rows, :n_modes, :, own] = places.rotation_mode
    return records


def fill_places(places: Places, records: Records) -> None:
    """Fill the fields for placing in records of `branch_layout`, (b,)."""
    records['first_record'], records['slot'], _ = assign_slots(
        places.first, places.parent, places.n_coordinates
    )
    records['parent'], records['base_segment'] = places.parent, places.base_segment
    records['first'], records['end'] = places.first[:-1], places.first[1:]
    records['coordinate'], records['n_coordinates'] = places.coordinate, places.n_coordinates
    records['frame'], records['offset'] = places.frame, places.offset
    records['skew'], records['tip_skew'] = places.skew, places.tip_skew
    k = min(places.base_rotation.shape[1], records['twist'].shape[1])
    records['twist'][:, :k, 3:] = places.base_rotation[:, :k]
    begin = places.first[:-1]
    steepest = np.maximum.reduceat(np.square(places.rotation_mode).sum(axis=2), begin)
    tips = np.maximum.reduceat(np.square(places.tip_slope), begin)
    records['steepest'][:, : steepest.shape[1]] = steepest
    records['steepest'][:, 0] = np.maximum(records['steepest'][:, 0], tips)


def rotation_modes_of(branch: np.void, segments: Records) -> Floats:
    """Rotation vector (m, k, 3) of each segment of a branch per unit of each coordinate."""
    first, count = int(branch['first_record']), int(branch['n_coordinates'])
    rows = slice(first, first + int(branch['end'] - branch['first']))
    if branch['load_mode'].shape[0] > 2:
        return np.asarray(segments['rotation_mode'][rows, :count, :, branch['slot']])
    slope, (_, e1, e2) = segments['slope'][rows, branch['slot']], branch['frame']
    return np.multiply.outer(slope, np.stack([e2, -e1]))


def block_records(branches: Records, segments: Records) -> Records:
    """
    Lay the fields for placing out in blocks, from `Branch` records whose coordinates are set.

    Records are of `block_layout`, one per block of `assign_slots` and one of scratch memory.
    """
    first, block = np.unique(branches['first_record'], return_inverse=True)
    slot, parent = branches['slot'], branches['parent']
    blocks = zeros_in_lines(len(first) + 1, block_layout(branches.dtype['load_mode'].shape[0]))
    blocks['first_record'] = [*first, len(segments)]
    blocks['n_records'][:-1] = np.diff(blocks['first_record'])
    blocks['n_slots'][:-1] = segments['n_slots'][first]
    blocks['n_eights'] = -(-blocks['n_slots'] // 8)
    np.maximum.at(blocks['n_parents'], block[parent[1:]], slot[parent[1:]] + 1)
    np.maximum.at(blocks['n_rows'], block, branches['n_coordinates'])
    blocks['branch'][block, slot] = np.arange(len(branches))
    blocks['is_joined'][:-1] = np.logical_and.reduceat(_joined(segments), first)
    np.maximum.at(blocks['n_parent_rows'], block, branches['n_coordinates'][parent])
    for name in ('parent', 'coordinate', 'base_segment', 'first'):
        blocks[name][block, slot] = branches[name]
    for name in ('frame', 'skew', 'tip_skew', 'offset', 'steepest'):
        blocks[name][block, ..., slot] = branches[name]
    blocks['bound_factor'][block, slot] = branches['n_coordinates'] - 1
    blocks['parent_coordinate'][block, slot] = branches['coordinate'][parent]
    ahead, beside = blocks['offset'][:, :1], np.abs(blocks['offset'][:, 1:])
    blocks['is_at_axes'] = (beside <= _AS_ONE * ahead).all(axis=(1, 2))
    blocks['base_rotation'][block, ..., slot] = branches['twist'][..., 3:]
    return blocks


_rotated = rotated.py_func  # type: ignore[attr-defined]  # whole arrays at once
_AS_ONE = 1e-12
"""
Largest deviation of a segment from a chord that it is taken to span, as a share of the chord.
"""


def _joined(segments: Records) -> NDArray[np.bool_]:
    """Fill chords in the frames of their segments; return where the chord is the x axis."""
    w, x, y, z = np.moveaxis(segments['rest'], 1, 0)
    own_chord = _rotated(w, -x, -y, -z, *np.moveaxis(segments['chord'], 1, 0))
    segments['own_chord'] = np.stack(own_chord, axis=1)
    return (np.hypot(own_chord[1], own_chord[2]) <= _AS_ONE * own_chord[0]).all(axis=1)


def assign_slots(
    first: Ints, branch_parent: Ints, fields: Ints | None = None
) -> tuple[Ints, Ints, int]:
    """
    Assign a slot of a block to each branch: parents first, similar lengths together.

    Branches of similar numbers of ``fields`` (b,), if given, are together as well.

    Returns
    -------
    tuple
        First record (b,) and slot (b,) of each branch; number of records.

    """
    size = np.diff(first)
    children: list[list[int]] = [[] for _ in size]
    carried = np.ones(len(size), dtype=np.int64)
    for branch in range(len(size) - 1, 0, -1):
        children[branch_parent[branch]].insert(0, branch)
        carried[branch_parent[branch]] += carried[branch]
    block, slot = np.zeros((2, len(size)), dtype=np.int64)
    # The time to place sixteen branches is that of the one with most fields.
    rich = (-fields if fields is not None else 0 * size).tolist()
    begin, ready = 0, [(rich[0], -int(size[0]), 0, -int(carried[0]), 0)]
    while ready:
        together = [heappop(ready)[-1] for _ in range(min(WIDTH, len(ready)))]
        # Records have segments of the first slots only.
        together.sort(key=lambda branch: -int(size[branch]))
        block[together], slot[together] = begin, np.arange(len(together))
        begin += int(size[together[0]])
        for branch in together:
            for child in children[branch]:
                last = rich[branch], -int(carried[child]), child
                heappush(ready, (rich[child], -int(size[child]), *last))
    return block, slot, begin


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


def load_records(branches: Records, layout: np.dtype[np.void] | None = None) -> Records:
    """
    Lay the wind load of `Branch` records, (b,), out in sixteens, (ceil(b / 16),).

    Records are at rest, without force, and of `load_layout` with the rows of the branches, or of a
    layout with further fields, which are zero.
    """
    if layout is None:
        layout = load_layout(branches.dtype['load_mode'].shape[0])
    records = zeros_in_lines(-(-len(branches) // WIDTH), layout)
    block, slot = np.divmod(np.arange(len(branches)), WIDTH)
    for name in ('speed', 'area', 'spread', 'projector'):
        records[name][block, ..., slot] = branches[name]
    for name in ('damping_mode', 'load_rotation', 'load_mode'):
        rows = records.dtype[name].shape[0]
        records[name][block, ..., slot] = branches[name][:, :rows]
    records['chord_lever'][block, :, slot] = branches['lever'][:, None] * branches['frame'][:, 0]
    at_base = cross(branches['base'][:, None], np.eye(3)).swapaxes(1, 2)
    records['coupling'][block, ..., slot] = branches['coupling'] - at_base
    np.maximum.at(records['n_rows'], block, branches['n_coordinates'])
    return records
