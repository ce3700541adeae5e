# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The one place where records are filled: what stepping and placing know of a tree.

`branch_records` writes all of a branch, `moving_records` what is left when some are frozen,
`copy_twigs` which of them copy; `segment_records`, `head_records` and `load_records` lay the same
out in lanes.
"""

from __future__ import annotations

from collections.abc import Sequence
from heapq import heappop, heappush
import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from tree_sway_ros.core.arrays import Floats, Ints, Record, Records
from tree_sway_ros.core.branch.beam import cross, cross_matrix
from tree_sway_ros.core.branch.model import BranchModel
from tree_sway_ros.core.branch.shapes import across, exposure
from tree_sway_ros.core.motion.records import (
    branch_layout,
    head_layout,
    LANES,
    load_layout,
    segment_layout,
    zeros_in_lines,
)
from tree_sway_ros.core.reduction.matrices import Reduction
from tree_sway_ros.core.rotation import rotated
from tree_sway_ros.core.tree.tree import Tree

if TYPE_CHECKING:
    from tree_sway_ros.core.reduction.pruning import Pruning


def segment_records(tree: Tree, models: list[BranchModel]) -> Records:
    """Fill what placing needs of each segment: `segment_layout` records, in blocks of `lanes`."""
    block, lane, n_records = lanes(tree, models)
    is_plain = all(len(model.fields) == 2 for model in models)
    records = zeros_in_lines(n_records, segment_layout(2) if is_plain else segment_layout())
    records['rest'][:, 0] = 1.0
    size = np.diff(tree.branch_first)
    rows = np.arange(tree.n_segments) + np.repeat(block - tree.branch_first[:-1], size)
    own, following = np.repeat(lane, size), tree.end.copy()
    within = np.ones(tree.n_segments, dtype=bool)
    within[tree.branch_first[1:] - 1] = False
    following[within] = tree.start[1:][within[:-1]]
    records['chord'][rows, :, own] = following - tree.start
    records['rest'][rows, :, own] = tree.rest_frame
    records['slope'][rows, own], records['tip_slope'][rows, own] = _slopes(tree, models)
    np.maximum.at(records['n_lanes'], rows, own + 1)
    if not is_plain:
        for branch, model in enumerate(models):
            for c, turn in enumerate(_drawn_turns(model)):
                records['turn'][rows[tree.segments_of(branch)], c, :, lane[branch]] = turn
    return records


def turns_of_segments(branch: np.void, segments: Records) -> Floats:
    """Rotation vector (m, k, 3) of each segment of a branch per unit of each coordinate."""
    first, count = int(branch['block']), int(branch['n_coordinates'])
    rows = slice(first, first + int(branch['end'] - branch['first']))
    if branch['push'].shape[0] > 2:
        turns: Floats = segments['turn'][rows, :count, :, branch['lane']]
        return turns
    slope, (_, e1, e2) = segments['slope'][rows, branch['lane']], branch['frame']
    return np.multiply.outer(slope, np.stack([e2, -e1]))


def head_records(branches: Records, segments: Records) -> Records:
    """
    Lay out what placing needs to know of `BRANCH` records, whose coordinates are set.

    Records of `head_layout`, one per block of `lanes` and one to work in.
    """
    first, block = np.unique(branches['block'], return_inverse=True)
    lane, parent = branches['lane'], branches['parent']
    heads = zeros_in_lines(len(first) + 1, head_layout(branches.dtype['push'].shape[0]))
    heads['block'] = [*first, len(segments)]
    heads['n_records'][:-1] = np.diff(heads['block'])
    heads['n_lanes'][:-1] = segments['n_lanes'][first]
    np.maximum.at(heads['n_bearing'], block[parent[1:]], lane[parent[1:]] + 1)
    np.maximum.at(heads['n_rows'], block, branches['n_coordinates'])
    heads['branch'][block, lane] = np.arange(len(branches))
    heads['is_joined'][:-1] = np.logical_and.reduceat(_joined(segments), first)
    np.maximum.at(heads['n_parent_rows'], block, branches['n_coordinates'][parent])
    for name in ('parent', 'coordinate', 'base_segment', 'first'):
        heads[name][block, lane] = branches[name]
    for name in ('frame', 'skew', 'tip_skew', 'offset'):
        heads[name][block, ..., lane] = branches[name]
    heads['is_at_axes'] = (np.abs(heads['offset'][:, 1:]) <= _AS_ONE * heads['offset'][:, :1]).all(
        axis=(1, 2)
    )
    heads['steepest'][block, lane] = branches['steepest'][:, 0]
    heads['base_turn'][block, ..., lane] = branches['twist'][..., 3:]
    return heads


_rotated = rotated.py_func  # type: ignore[attr-defined]  # whole arrays at once
_AS_ONE = 1e-12
"""Share of a chord by which a segment may miss it and still reach from its start to its end."""


def _joined(segments: Records) -> NDArray[np.bool_]:
    """Tell chords in each segment's own frame, and of which records they run along its x axis."""
    w, x, y, z = np.moveaxis(segments['rest'], 1, 0)
    reach = _rotated(w, -x, -y, -z, *np.moveaxis(segments['chord'], 1, 0))
    segments['reach'] = np.stack(reach, axis=1)
    return (np.hypot(reach[1], reach[2]) <= _AS_ONE * reach[0]).all(axis=1)


def lanes(tree: Tree, models: list[BranchModel]) -> tuple[Ints, Ints, int]:
    """
    Give each branch a lane of a block: parents first, long branches together, few lanes empty.

    Returns
    -------
    tuple
        First record (b,) and lane (b,) of each branch; how many records there are.

    """
    size = np.diff(tree.branch_first)
    children: list[list[int]] = [[] for _ in size]
    for branch, parent in enumerate(tree.branch_parent[1:].tolist(), start=1):
        children[parent].append(branch)
    block, lane = np.zeros((2, len(size)), dtype=np.int64)
    carried = (tree.subtree_end - np.arange(len(size))).tolist()
    first, ready = 0, [(-int(size[0]), -carried[0], 0)]
    while ready:
        together = [heappop(ready)[-1] for _ in range(min(LANES, len(ready)))]
        block[together], lane[together] = first, np.arange(len(together))
        first += int(size[together[0]])
        for branch in together:
            for child in children[branch]:
                heappush(ready, (-int(size[child]), -carried[child], child))
    return block, lane, first


def branch_records(
    tree: Tree,
    models: list[BranchModel],
    reduction: Reduction,
    speed_profile: Floats,
    layout: np.dtype[np.void] | None = None,
    known: Sequence[tuple[list[BranchModel], Records]] = (),
) -> Records:
    """
    All that stepping and placing know of the branches: records of `BRANCH`, (b,), or of a layout.

    The profile is the wind speed at each segment over that at the anemometer, (n,). What a model
    is among other models of the same tree whose records are `known`, is taken from there.
    """
    records = np.zeros(tree.n_branches, dtype=branch_layout() if layout is None else layout)
    new = np.ones(tree.n_branches, dtype=bool)
    for others, filled in known:
        same = new & [one is other for one, other in zip(models, others, strict=True)]
        new &= ~same
        for name in _OF_MODEL:
            found = filled[name][same]
            k = min(found.shape[1], records[name].shape[1]) if found.ndim > 1 else 0
            records[name][(same, slice(k)) if k else same] = found[:, :k] if k else found
    for branch in np.flatnonzero(new).tolist():
        _fill_ways(models[branch], records[branch])
        _fill_load(models[branch], speed_profile[tree.segments_of(branch)], records[branch])
    first = tree.branch_first[:-1]
    records['block'], records['lane'], _ = lanes(tree, models)
    records['parent'], records['source'] = tree.branch_parent, np.arange(tree.n_branches)
    records['first'], records['end'] = first, tree.branch_first[1:]
    records['base_segment'] = tree.segment_parent[first]
    records['coordinate'] = reduction.first[:-1]
    records['twist'] = reduction.twist[:, : records['twist'].shape[1]]
    records['tip'] = tree.end[tree.branch_first[1:] - 1] - tree.start[0]
    _fill_slopes(tree, models, records)
    _fill_arms(tree, records)
    _fill_axial_levers(records)
    return records


def _fill_arms(tree: Tree, records: Records) -> None:
    """Fill where bases are at rest."""
    first, on = tree.branch_first[:-1], records['base_segment']
    base = tree.start[first] - tree.start[0]
    arm = base - base[np.maximum(tree.branch_parent, 0)]
    square = np.square(arm).sum(axis=1)
    records['base'], records['arm'] = base, arm
    records['per_arm'] = np.divide(0.5, square, out=np.zeros_like(square), where=square > 0.0)
    w, x, y, z = tree.rest_frame[on].T
    offset = np.stack(_rotated(w, -x, -y, -z, *(tree.start[first] - tree.start[on]).T), axis=1)
    records['offset'] = np.where(on[:, None] >= 0, offset, 0.0)


def _fill_slopes(tree: Tree, models: list[BranchModel], records: Records) -> None:
    """Fill how the shapes that branches are drawn by are laid and skewed."""
    first, size = tree.branch_first[:-1], np.diff(tree.branch_first)
    share = tree.length / np.repeat(np.add.reduceat(tree.length, first), size)
    slopes = _slopes(tree, models)
    for name, slope in zip(('skew', 'tip_skew'), slopes, strict=True):
        off = slope - np.repeat(np.add.reduceat(share * slope, first), size)
        # The third cumulant over 6: how far the chord angle lags, per angle cubed.
        records[name] = np.add.reduceat(share * off**3, first) / 6.0
    most = np.maximum.reduceat(slopes[1] ** 2, first)
    records['steepest'][:, 0] = np.maximum(records['steepest'][:, 0], most)


def _fill_ways(model: BranchModel, record: Record) -> None:
    """Fill what a branch does by its coordinates."""
    record['n_coordinates'] = len(model.fields)
    for i, (field, turn) in enumerate(zip(model.fields, _drawn_turns(model), strict=True)):
        record['reach'][i] = field.nodes[-1]
        record['steepest'][i] = np.square(turn).sum(axis=1).max()
    record['frame'] = model.beam.chord, *across(model.beam.chord)


_OF_MODEL = (
    'n_coordinates', 'frame', 'push', 'flow', 'spread', 'reach', 'turn', 'lever', 'area', 'speed',
    'centre', 'couple', 'projector', 'steepest',
)  # fmt: skip
"""What of a record follows from the model of a branch alone."""

_STRAIGHT = 0.03
"""Share of the wind along a branch below which this is not told apart from none."""


def _fill_load(model: BranchModel, speed_profile: Floats, record: Record) -> None:
    """Fill what the wind load reads; wind speed at its segments over that at the anemometer."""
    beam = model.beam
    weight = model.drag_area * beam.weight
    total = weight.sum()
    share = weight / total
    record['centre'] = np.einsum('sg,sgk->k', share, beam.point)
    record['couple'] = cross_matrix(record['centre'])
    speed = float((share * speed_profile[beam.segment, None]).sum())
    record['speed'] = speed
    record['area'] = total / speed**2 if speed > 0.0 else 0.0
    along = np.einsum('sg,si,sj->ij', share, beam.tangent, beam.tangent)
    across = np.eye(3) - along
    record['projector'] = across[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]
    exposed = exposure(beam)
    exposed /= float(share.sum(axis=1) @ exposed)
    amounts, axes = np.linalg.eigh(across)
    kept = amounts > _STRAIGHT * amounts[-1]
    into_push = axes[:, kept] / amounts[kept] @ axes[:, kept].T
    n = len(model.fields)
    fields = np.stack([one.points for one in model.fields])
    own = exposed[:, None] * (share[..., None] * fields).sum(axis=2)
    own -= (own * beam.tangent).sum(axis=-1, keepdims=True) * beam.tangent
    mean = np.zeros_like(record['push'])
    mean[:n] = own.sum(axis=1)
    record['push'][:n] = mean[:n] @ into_push
    along_it = (fields[:2] * beam.tangent[:, None, :]).sum(axis=-1)
    moved = (np.square(fields[:2]).sum(axis=-1) - np.square(along_it)).sum(axis=0)
    # What moves most does most work, and it is turned most.
    work = share * np.sqrt(np.maximum(moved, 0.0))
    work /= work.sum() if work.sum() > 0.0 else 1.0
    slopes = np.stack([one.slope for one in model.fields])
    record['turn'][:n] = work.ravel() @ slopes.reshape(n, -1, 3)
    if np.abs(beam.tangent @ beam.tangent[0] - 1.0).max() > 1e-9:
        _fit_load(model, share, record)
    _fill_flow(record, mean, float((share * moved).sum()), float((share * _cubes(moved)).sum()))


def _cubes(squares: Floats) -> Floats:
    """Cubes of displacements from the sum of their squares, as if both axes were alike."""
    cubes: Floats = 2.0 * np.maximum(0.5 * squares, 0.0) ** 1.5
    return cubes


def _fit_load(model: BranchModel, share: Floats, record: Record) -> None:
    """Fit projector, push and couple of a crooked branch to the drag on it (least squares)."""
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
    record['couple'] += (fit @ (moment - force @ record['couple'].T)).T
    k = len(model.fields)
    moved = np.stack([(share[..., None] * one.points).sum(axis=1) for one in model.fields])
    pushed = np.einsum('dsk,csk->dc', pieces, moved)
    record['push'][:k] += (fit @ (pushed - force @ record['push'][:k].T)).T


def _fill_flow(record: Record, mean: Floats, square: float, cube: float) -> None:
    """
    Scale the displacement across the branch to that at which drag damps as its mean square does.

    Both axes of the first shape count as one, so that it does not matter how they are laid.

    In wind this damps as the pieces do. In still air they do so by the mean cube, which needs a
    speed of mean cube over mean square: what the flow lacks of that is the spread.
    """
    across = float(np.square(mean[:2]).sum())
    record['flow'] = mean
    record['flow'][:2] *= square / across if across > 0.0 else 1.0
    still = (cube / square) ** 2 if square > 0.0 else 0.0
    record['spread'] = max(still - 0.5 * float(np.square(record['flow'][:2]).sum()), 0.0)
    record['lever'] = math.sqrt(0.5 * across)


def _fill_axial_levers(records: Records) -> None:
    """Find how far each subtree's load centre swings across per turn of the parent's chord."""
    area = records['area'].copy()
    moment = records['centre'] * area[:, None]
    for b in range(len(records) - 1, 0, -1):
        parent = records['parent'][b]
        twist, across = records[b]['twist'][:2], records[parent]['frame'][1:]
        centre = moment[b] / area[b] if area[b] > 0.0 else records[b]['centre']
        moved = twist[:, :3] + twist[:, 3:] @ cross_matrix(centre)
        records[b]['axial_lever'] = 0.5 * float((moved * across).sum())
        area[parent] += area[b]
        moment[parent] += moment[b]


def copy_twigs(records: Records, source: Ints) -> None:
    """
    Let twigs copy others: each turns about the axes of its source, so that it moves the same one.

    The source is itself where a branch is solved, (b,).
    """
    records['source'] = source
    records['frame'] = records['frame'][source]


def moving_records(pruning: Pruning, whole: Records) -> Records:
    """
    Make the records of the moving branches, the load of what they carry in their own, (m,).

    They are complete but for their place in blocks, which `segment_records` shares.
    """
    moving, place = pruning.moving, pruning.place_among_moving
    records = whole[moving].copy()
    carrier, top = pruning.carriers(), pruning.top_of()
    for at in np.unique(carrier[pruning.frozen]):
        load = np.flatnonzero(pruning.frozen & (carrier == at))
        _join_loads(records[place[at]], whole[at], whole[load], whole['twist'][top[load]])
    records['parent'] = place[records['parent']]
    records['source'] = np.arange(len(records))
    counts = records['n_coordinates']
    records['coordinate'] = np.cumsum(counts) - counts
    return records


def _join_loads(record: Record, own: Record, loads: Records, twists: Floats) -> None:
    """
    Make loads that a branch carries part of its own.

    Drag on a slanted piece is not linear in its projector P, but it is the slope of ``c (u . P
    u)^1.5 / 3`` in the wind u. The projector of all is the one that comes nearest to the sum of
    these.

    Parameters
    ----------
    record
        Of the branch, written.
    own
        The same before.
    loads, twists
        Records of what it carries, (k,), and how a unit of its coordinates moves each, (k, c, 6).

    """
    area = np.append(own['area'], loads['area'])
    speed = np.append(own['speed'], loads['speed'])
    pressed = area * speed**2
    if not pressed.any():
        return
    projectors = np.vstack([own['projector'], loads['projector']])
    slanting = _SlantingWinds(pressed @ np.vstack([own['centre'], loads['centre']]))
    drag = slanting.squares(projectors) ** 1.5 * pressed
    share = drag.sum(axis=0) / drag.sum()
    both = (drag.sum(axis=1) / pressed.sum()) ** (2.0 / 3.0)
    record['projector'] = slanting.nearest(both)
    record['speed'] = share @ speed
    record['area'] = pressed.sum() / record['speed'] ** 2
    centre = loads['centre']
    moved = twists[:, :, :3] + np.cross(twists[:, :, 3:], centre[:, None])
    record['centre'] = share[0] * own['centre'] + share[1:] @ centre
    record['couple'] = share[0] * own['couple'] + np.tensordot(share[1:], loads['couple'], axes=1)
    record['push'] = share[0] * own['push'] + np.tensordot(share[1:], moved, axes=1)
    record['turn'] = share[0] * own['turn'] + np.tensordot(share[1:], twists[:, :, 3:], axes=1)
    xx, yy, zz, xy, xz, yz = own['projector']
    mean = own['push'] @ np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    damped = float((mean[:2] * own['flow'][:2]).sum())
    still = math.sqrt(own['spread'] + 0.5 * float(np.square(own['flow'][:2]).sum()))
    squares = np.square(moved[:, :2]).sum(axis=(1, 2))
    square = share[0] * damped + share[1:] @ squares
    cube = share[0] * damped * still + share[1:] @ _cubes(squares)
    mean = share[0] * mean + np.tensordot(share[1:], moved, axes=1)
    _fill_flow(record, mean, float(square), float(cube))


class _SlantingWinds:
    """
    Winds from all sides, along the ground and, as branches bend, aslant.

    The first comes from the side that a direction (3,) points to, so that a tree that is turned as
    a whole has the same load from the side that is turned with it.
    """

    def __init__(self, direction: Floats) -> None:
        """Lay 16 bearings on each of three rises."""
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
        squares: Floats = np.maximum(self._weights @ projectors.T, 0.0)
        return squares

    def nearest(self, squares: Floats) -> Floats:
        """Return the projector (6,) whose squares come nearest to these, (48,)."""
        projector: Floats = np.linalg.lstsq(self._weights, squares, rcond=None)[0]
        return projector


def _drawn_turns(model: BranchModel) -> Floats:
    """
    Rotation vector of each segment per unit of each coordinate, as it is drawn, (k, m, 3).

    A plain branch turns by one slope about the axes across its chord.
    """
    if len(model.fields) == 2:
        e1, e2 = across(model.beam.chord)
        return np.multiply.outer(model.shape.segment_slope, [e2, -e1]).transpose(1, 0, 2)
    return np.stack([model.beam.over_segments(one.slope) for one in model.fields])


def _slopes(tree: Tree, models: list[BranchModel]) -> tuple[Floats, Floats]:
    """
    Slope of each segment as its branch is drawn, and under a load at the tip, both (n,).

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
    Lay out what the wind load knows of `BRANCH` records, (b,), sixteen at a time, (ceil(b / 16),).

    At rest, with no force so far; of `load_fields` with as many rows as the branches have, or of a
    layout with further fields, which are left zeros.
    """
    if layout is None:
        layout = load_layout(branches.dtype['push'].shape[0])
    records = zeros_in_lines(-(-len(branches) // LANES), layout)
    block, lane = np.divmod(np.arange(len(branches)), LANES)
    for name in ('speed', 'area', 'spread', 'projector', 'centre'):
        records[name][block, ..., lane] = branches[name]
    for name in ('flow', 'turn', 'push'):
        rows = records.dtype[name].shape[0]
        records[name][block, ..., lane] = branches[name][:, :rows]
    records['along'][block, :, lane] = branches['lever'][:, None] * branches['frame'][:, 0]
    at_base = cross(branches['base'][:, None], np.eye(3)).swapaxes(1, 2)
    records['couple'][block, ..., lane] = branches['couple'] - at_base
    records['is_solved'][block, lane] = branches['source'] == np.arange(len(branches))
    np.maximum.at(records['n_rows'], block, branches['n_coordinates'])
    return records
