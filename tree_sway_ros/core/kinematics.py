"""
Key rotations to poses: the segments of each branch follow its key, the branches are joined from the root.

A segment turns by its slope times the branch's rotation vector, so a branch bends as one smooth curve and keeps
its length. The chord of the bent chain turns by a little less than the coordinate says (third cumulant of the slope
along the branch); the coordinate is stretched by that much, so that the chord angle is kept. Beyond 30 degrees a
tapered branch goes over to the slope of a load at the tip.

The pose block is (n, 7) float64 in message order: x y z, then the quaternion as x y z w. A pose stands at its segment's
root-side node, its x axis runs along the segment (REP-103).

"""

from __future__ import annotations

from typing import Any

import numpy as np

from tree_sway_ros.core.branch_beam import SlopeShape
from tree_sway_ros.core.branch_model import BranchModel
from tree_sway_ros.core.branch_shapes import N_SHAPES
from tree_sway_ros.core.kernel import fused
from tree_sway_ros.core.layout import SEGMENT
from tree_sway_ros.core.rotation import (
    SMALL_HALF_ANGLE,
    product,
    quaternion,
    quaternions_from_x,
    rotated,
    small_half_angle,
)
from tree_sway_ros.core.tree import Floats, Tree

_BLEND_FROM = np.deg2rad(30.0) ** 2
_BLEND_TO = np.deg2rad(45.0) ** 2
_STRETCH_TO = np.deg2rad(90.0) ** 2


def segment_records(tree: Tree, models: list[BranchModel]) -> Any:
    """
    Fill what placing needs to know of each segment.

    Returns
    -------
    ndarray
        Of dtype `SEGMENT`, (n,).

    """
    records = np.zeros(tree.n_segments, dtype=SEGMENT)
    records["length"] = tree.length
    records["rest"] = quaternions_from_x((tree.end - tree.start) / tree.length[:, None])
    for branch, model in enumerate(models):
        here = tree.segments_of(branch)
        records["gap"][here.start : here.stop - 1] = tree.start[here][1:] - tree.end[here][:-1]
        for column, shape in _distinct_shapes(model):
            records["slope"][here, column] = shape.segment_slope
        records["tip_slope"][here] = _tip_load_slope(model)
    records["has_gap"] = np.abs(records["gap"]).max(axis=1) > 1e-12
    return records


def fill_branch_geometry(tree: Tree, models: list[BranchModel], records: Any) -> None:
    """Fill the fields of `BRANCH` records that placing reads."""
    rest = quaternions_from_x((tree.end - tree.start) / tree.length[:, None])
    for branch, model in enumerate(models):
        record, here = records[branch], tree.segments_of(branch)
        record["parent"] = tree.branch_parent[branch]
        record["seat"] = tree.segment_parent[here.start]
        record["first"], record["end"] = here.start, here.stop
        record["n_coordinates"] = len(model.coordinates)
        record["n_pairs"] = sum(not way.is_twist for way in model.coordinates) // 2
        record["source"] = branch
        for i, way in enumerate(model.coordinates):
            record["reach"][i] = way.shape.displacement(way.axis)[1][-1]
        record["steepest"] = np.square(model.coordinates[0].shape.segment_slope).max() * 1.2
        record["is_straight"] = _is_straight(tree, here)
        record["tip"] = tree.end[here.stop - 1] - tree.start[0]
        record["frame"] = model.beam.chord, -model.coordinates[1].axis, model.coordinates[0].axis
        for column, shape in _distinct_shapes(model):
            records["seat_slope"][model.children, column] = shape.child_slope
        length = model.beam.length
        record["skew"] = _skew(model.coordinates[0].shape.segment_slope, length)
        record["tip_skew"] = _skew(_tip_load_slope(model), length)
        if record["seat"] >= 0:
            w, x, y, z = rest[record["seat"]]
            offset = tree.start[here.start] - tree.start[record["seat"]]
            record["offset"] = rotated.py_func(w, -x, -y, -z, *offset)  # type: ignore[attr-defined]


def _distinct_shapes(model: BranchModel) -> list[tuple[int, SlopeShape]]:
    """Shapes of a branch with the column of each: pairs share theirs, twists come after all shapes."""
    pairs = [way.shape for way in model.coordinates if not way.is_twist][::2]
    twists = [way.shape for way in model.coordinates if way.is_twist]
    return [*enumerate(pairs), *enumerate(twists, start=N_SHAPES)]


def _is_straight(tree: Tree, here: slice) -> bool:
    """Whether all segments of a branch lie on one line, end to end."""
    tangent = (tree.end[here] - tree.start[here]) / tree.length[here, None]
    gap = tree.start[here][1:] - tree.end[here][:-1]
    return bool((abs(tangent - tangent[0]) < 1e-12).all() and (abs(gap) < 1e-12).all())


def _skew(slope: Floats, length: Floats) -> float:
    """Third cumulant over 6 of a slope along a branch: how far its chord angle lags, per angle cubed."""
    share = length / length.sum()
    return float(share @ (slope - share @ slope) ** 3) / 6.0


def _tip_load_slope(model: BranchModel) -> Floats:
    """Mean over each segment of 1.5 (2 u - u^2), u the arc length over the length: a load at the tip."""
    u = model.beam.node / model.beam.node[-1]
    first: SlopeShape = model.coordinates[0].shape
    primitive = 1.5 * (u * u - u**3 / 3.0)
    mean = float(first.segment_slope @ model.beam.length) / float(model.beam.node[-1])
    slope: Floats = mean * np.diff(primitive) / np.diff(u)
    return slope


@fused
def place(branches: Any, segments: Any, work: Any, x: Floats, origin: Floats, out: Floats) -> None:
    """
    Place every segment.

    Parameters
    ----------
    branches, segments, work
        Records of `BRANCH` (b,), `SEGMENT` (n,) and `WORK` (b,); the bases of `work` are written.
    x
        Key rotations, (N,), in the order of the coordinates.
    origin
        Root node, (3,).
    out
        Pose block to write, (n, 7).

    """
    for b in range(len(branches)):
        branch = branches[b]
        if branch.parent < 0:
            dw, dx, dy, dz = 1.0, 0.0, 0.0, 0.0
            px, py, pz = origin[0], origin[1], origin[2]
        else:
            dw, dx, dy, dz, px, py, pz = _seat(branches, branch, work, x, out)
        base = work[b].base
        base[0], base[1], base[2], base[3] = dw, dx, dy, dz
        i, k = branch.coordinate, branch.n_coordinates
        t = x[i] * x[i] + x[i + 1] * x[i + 1]
        if k == 2 and t <= _BLEND_FROM and t * branch.steepest <= 4.0 * SMALL_HALF_ANGLE:
            _follow_in_plane(branch, segments, x[i], x[i + 1], dw, dx, dy, dz, px, py, pz, out)
        else:
            _follow(branch, segments, x, dw, dx, dy, dz, px, py, pz, out)


@fused
def _follow_in_plane(
    branch: Any, segments: Any, x: float, y: float,
    dw: float, dx: float, dy: float, dz: float, px: float, py: float, pz: float, out: Floats,
) -> None:  # fmt: skip
    """
    Place the segments of a branch that bends about one axis, and not far.

    With h half the branch's rotation vector and D the base, a segment of slope psi is turned by
    ``cos(psi |h|) D + psi sinc(psi |h|) (D h)``: the second product is the same for all segments, and where the branch is
    straight, so is the orientation at rest that follows.

    """
    frame = branch.frame
    half = 0.5 * (1.0 + (x * x + y * y) * branch.skew)
    x, y = half * x, half * y
    hx = x * frame[2, 0] - y * frame[1, 0]
    hy = x * frame[2, 1] - y * frame[1, 1]
    hz = x * frame[2, 2] - y * frame[1, 2]
    square = hx * hx + hy * hy + hz * hz
    ew, ex, ey, ez = product(dw, dx, dy, dz, 0.0, hx, hy, hz)
    if branch.is_straight:
        r = segments[branch.first].rest
        dw, dx, dy, dz = product(dw, dx, dy, dz, r[0], r[1], r[2], r[3])
        ew, ex, ey, ez = product(ew, ex, ey, ez, r[0], r[1], r[2], r[3])
        for j in range(branch.first, branch.end):
            slope = segments[j].slope[0]
            c, s = small_half_angle(slope * slope * square)
            s *= slope
            px, py, pz = _put(
                c * dw + s * ew, c * dx + s * ex, c * dy + s * ey, c * dz + s * ez,
                segments[j].length, px, py, pz, out, j,
            )  # fmt: skip
        return
    for j in range(branch.first, branch.end):
        segment = segments[j]
        slope = segment.slope[0]
        c, s = small_half_angle(slope * slope * square)
        s *= slope
        qw, qx, qy, qz = c * dw + s * ew, c * dx + s * ex, c * dy + s * ey, c * dz + s * ez
        px, py, pz = _turn(segment, qw, qx, qy, qz, px, py, pz, out, j)


@fused
def _follow(
    branch: Any, segments: Any, x: Floats,
    dw: float, dx: float, dy: float, dz: float, px: float, py: float, pz: float, out: Floats,
) -> None:  # fmt: skip
    """Place the segments of a branch that bends far, has further shapes or twists."""
    i, frame, pairs = branch.coordinate, branch.frame, branch.n_pairs
    twists = branch.n_coordinates - 2 * pairs
    x0, y0, x1, y1, x2, y2 = x[i], x[i + 1], 0.0, 0.0, 0.0, 0.0
    if pairs > 1:
        x1, y1 = x[i + 2], x[i + 3]
    if pairs > 2:
        x2, y2 = x[i + 4], x[i + 5]
    i += 2 * pairs
    t0 = x[i] if twists > 0 else 0.0
    t1 = x[i + 1] if twists > 1 else 0.0
    t2 = x[i + 2] if twists > 2 else 0.0
    t = x0 * x0 + y0 * y0
    blend = min(max((t - _BLEND_FROM) / (_BLEND_TO - _BLEND_FROM), 0.0), 1.0)
    stretch = 1.0 + min(t, _STRETCH_TO) * (branch.skew + blend * (branch.tip_skew - branch.skew))
    for j in range(branch.first, branch.end):
        segment = segments[j]
        slope = segment.slope
        first = stretch * (slope[0] + blend * (segment.tip_slope - slope[0]))
        ux = first * x0 + slope[1] * x1 + slope[2] * x2
        uy = first * y0 + slope[1] * y1 + slope[2] * y2
        spin = slope[N_SHAPES] * t0 + slope[N_SHAPES + 1] * t1 + slope[N_SHAPES + 2] * t2
        qw, qx, qy, qz = quaternion(
            ux * frame[2, 0] - uy * frame[1, 0] + spin * frame[0, 0],
            ux * frame[2, 1] - uy * frame[1, 1] + spin * frame[0, 1],
            ux * frame[2, 2] - uy * frame[1, 2] + spin * frame[0, 2],
        )
        qw, qx, qy, qz = product(dw, dx, dy, dz, qw, qx, qy, qz)
        px, py, pz = _turn(segment, qw, qx, qy, qz, px, py, pz, out, j)


@fused
def _turn(
    segment: Any, qw: float, qx: float, qy: float, qz: float, px: float, py: float, pz: float,
    out: Floats, j: int,
) -> tuple[float, float, float]:  # fmt: skip
    """Write the pose of a segment turned by q from rest; return where the next one starts."""
    rest = segment.rest
    ow, ox, oy, oz = product(qw, qx, qy, qz, rest[0], rest[1], rest[2], rest[3])
    px, py, pz = _put(ow, ox, oy, oz, segment.length, px, py, pz, out, j)
    if segment.has_gap:
        gap = segment.gap
        gx, gy, gz = rotated(qw, qx, qy, qz, gap[0], gap[1], gap[2])
        px, py, pz = px + gx, py + gy, pz + gz
    return px, py, pz


@fused
def _put(
    ow: float, ox: float, oy: float, oz: float, length: float, px: float, py: float, pz: float,
    out: Floats, j: int,
) -> tuple[float, float, float]:  # fmt: skip
    """Write a pose; return where its segment ends."""
    out[j, 0], out[j, 1], out[j, 2] = px, py, pz
    out[j, 3], out[j, 4], out[j, 5], out[j, 6] = ox, oy, oz, ow
    twice = 2.0 * length
    return (
        px + length - twice * (oy * oy + oz * oz),
        py + twice * (ox * oy + oz * ow),
        pz + twice * (ox * oz - oy * ow),
    )


@fused
def _seat(
    branches: Any, branch: Any, work: Any, x: Floats, out: Floats
) -> tuple[float, float, float, float, float, float, float]:
    """Orientation and place of a branch's base on its placed parent."""
    parent = branches[branch.parent]
    i, pairs, slope, frame = parent.coordinate, parent.n_pairs, branch.seat_slope, parent.frame
    stretch = 1.0 + min(x[i] * x[i] + x[i + 1] * x[i + 1], _STRETCH_TO) * parent.skew
    ux, uy, spin = slope[0] * stretch * x[i], slope[0] * stretch * x[i + 1], 0.0
    for p in range(1, pairs):
        ux += slope[p] * x[i + 2 * p]
        uy += slope[p] * x[i + 2 * p + 1]
    for p in range(parent.n_coordinates - 2 * pairs):
        spin += slope[N_SHAPES + p] * x[i + 2 * pairs + p]
    qw, qx, qy, qz = quaternion(
        ux * frame[2, 0] - uy * frame[1, 0] + spin * frame[0, 0],
        ux * frame[2, 1] - uy * frame[1, 1] + spin * frame[0, 1],
        ux * frame[2, 2] - uy * frame[1, 2] + spin * frame[0, 2],
    )
    base = work[branch.parent].base
    dw, dx, dy, dz = product(base[0], base[1], base[2], base[3], qw, qx, qy, qz)
    s = branch.seat
    ox, oy, oz = rotated(
        out[s, 6],
        out[s, 3],
        out[s, 4],
        out[s, 5],
        branch.offset[0],
        branch.offset[1],
        branch.offset[2],
    )
    return dw, dx, dy, dz, out[s, 0] + ox, out[s, 1] + oy, out[s, 2] + oz
