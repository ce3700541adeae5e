"""
What placing knows of a tree, laid out for it: shapes of its branches, segments in lanes.

"""

from __future__ import annotations

from heapq import heappop, heappush
from typing import Any

import numpy as np

from tree_sway_ros.core.arrays import Floats
from tree_sway_ros.core.branch.beam import SlopeShape
from tree_sway_ros.core.branch.model import BranchModel
from tree_sway_ros.core.branch.shapes import N_SHAPES
from tree_sway_ros.core.motion.records import LANES, head_layout, segment_layout
from tree_sway_ros.core.rotation import quaternions_from_x, rotated
from tree_sway_ros.core.tree.tree import Tree


def segment_records(tree: Tree, models: list[BranchModel]) -> Any:
    """
    Fill what placing needs to know of each segment.

    Returns
    -------
    ndarray
        Of `segment_layout`, in blocks of `lanes`.

    """
    block, lane, n_records = lanes(tree, models)
    is_plain = all(len(model.coordinates) == 2 for model in models)
    records = np.zeros(n_records, dtype=segment_layout(1) if is_plain else segment_layout())
    records["rest"][:, 0] = 1.0
    rest = quaternions_from_x((tree.end - tree.start) / tree.length[:, None])
    for branch, model in enumerate(models):
        here = tree.segments_of(branch)
        rows = slice(block[branch], block[branch] + here.stop - here.start)
        own = lane[branch]
        start = tree.start[here]
        records["chord"][rows, :, own] = np.vstack([start[1:], tree.end[here][-1:]]) - start
        records["rest"][rows, :, own] = rest[here]
        for column, shape in _distinct_shapes(model):
            records["slope"][rows, column, own] = shape.segment_slope
        records["tip_slope"][rows, own] = _tip_load_slope(model)
        records["n_lanes"][rows] = np.maximum(records["n_lanes"][rows], own + 1)
    return records


def head_records(branches: Any, segments: Any) -> Any:
    """
    Lay out what placing needs to know of `BRANCH` records, whose coordinates are set.

    Returns
    -------
    ndarray
        Of `head_layout`, one a block of `lanes` and one to work in.

    """
    first, block = np.unique(branches["block"], return_inverse=True)
    lane, parent = branches["lane"], branches["parent"]
    heads = np.zeros(len(first) + 1, dtype=head_layout(segments["slope"].shape[1]))
    heads["block"] = [*first, len(segments)]
    heads["n_records"][:-1] = np.diff(heads["block"])
    heads["n_lanes"][:-1] = segments["n_lanes"][first]
    heads["is_plain"] = 1
    heads["is_plain"][block[branches["n_coordinates"] > 2]] = 0
    heads["branch"][block, lane] = np.arange(len(branches))
    heads["rides_plain"][block, lane] = (branches["n_coordinates"] == 2)[parent]
    for name in ("parent", "coordinate", "seat", "first", "frame", "skew", "tip_skew", "offset"):
        heads[name][block, ..., lane] = branches[name]
    for name in ("steepest", "seat_slope"):
        heads[name][block, lane] = branches[name][:, 0]
    return heads


def lanes(tree: Tree, models: list[BranchModel]) -> tuple[Any, Any, int]:
    """
    Give each branch a lane of a block: parents in earlier blocks, long branches together, so that
    few lanes stay empty.

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


def fill_branch_geometry(tree: Tree, models: list[BranchModel], records: Any) -> None:
    """Fill the fields of `BRANCH` records that placing reads."""
    rest = quaternions_from_x((tree.end - tree.start) / tree.length[:, None])
    records["block"], records["lane"], _ = lanes(tree, models)
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
        record["tip"] = tree.end[here.stop - 1] - tree.start[0]
        record["frame"] = model.beam.chord, -model.coordinates[1].axis, model.coordinates[0].axis
        for column, shape in _distinct_shapes(model):
            records["seat_slope"][model.children, column] = shape.child_slope
            record["steepest"][column] = np.square(shape.segment_slope).max()
        tip_load = _tip_load_slope(model)
        record["steepest"][0] = max(record["steepest"][0], np.square(tip_load).max())
        length = model.beam.length
        record["skew"] = _skew(model.coordinates[0].shape.segment_slope, length)
        record["tip_skew"] = _skew(tip_load, length)
        if record["seat"] >= 0:
            w, x, y, z = rest[record["seat"]]
            offset = tree.start[here.start] - tree.start[record["seat"]]
            record["offset"] = rotated.py_func(w, -x, -y, -z, *offset)  # type: ignore[attr-defined]


def _distinct_shapes(model: BranchModel) -> list[tuple[int, SlopeShape]]:
    """
    Shapes of a branch with the column of each: pairs share theirs, twists come after all shapes.

    """
    pairs = [way.shape for way in model.coordinates if not way.is_twist][::2]
    twists = [way.shape for way in model.coordinates if way.is_twist]
    return [*enumerate(pairs), *enumerate(twists, start=N_SHAPES)]


def _skew(slope: Floats, length: Floats) -> float:
    """
    Third cumulant over 6 of a slope along a branch: how far its chord angle lags, per angle cubed.

    """
    share = length / length.sum()
    return float(share @ (slope - share @ slope) ** 3) / 6.0


def _tip_load_slope(model: BranchModel) -> Floats:
    """
    Mean over each segment of 1.5 (2 u - u^2), u the arc length over the length: a load at the tip.

    """
    u = model.beam.node / model.beam.node[-1]
    first: SlopeShape = model.coordinates[0].shape
    primitive = 1.5 * (u * u - u**3 / 3.0)
    mean = float(first.segment_slope @ model.beam.length) / float(model.beam.node[-1])
    slope: Floats = mean * np.diff(primitive) / np.diff(u)
    return slope
