# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
What a receiver needs to rebuild every pose from a frame: the rest tree, how its branches bend, and
the basis of the state.

A branch that moves with its parent as one body has no coordinate, and slopes of 0. Trees of a scene
follow each other in every array.

"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from tree_sway_ros.core.arrays import Floats
from tree_sway_ros.core.leaves.flutter import FLUTTER_GAIN, LARGEST_ANGLE
from tree_sway_ros.core.leaves.foliage import LeafClusters
from tree_sway_ros.core.motion.fill_records import turns_of_segments
from tree_sway_ros.core.rotation import rotated
from tree_sway_ros.core.simulator.protocol import Simulator
from tree_sway_ros.core.tree.tree import Tree
from tree_sway_ros.page.protocol import Array, LeafyHeader, encode_description
from tree_sway_ros.page.told_basis import ToldBasis, ToldTree

RIGID = -1
"""Coordinate of a branch that has none."""


def describe_scene(
    simulator: Simulator,
    told: Sequence[ToldTree],
    bases: Sequence[ToldBasis],
    *,
    frame_id: str = "map",
    leaves: LeafClusters | None = None,
) -> bytes:
    """
    Describe a tree or a forest for receivers of its state.

    Parameters
    ----------
    simulator
        Of a tree, a forest or a stand, on the model whose state will be sent.
    told, bases
        Each tree of it, and its basis.
    frame_id
        Frame of the poses.
    leaves
        Clusters of leaves of all trees together; None without.

    Returns
    -------
    bytes
        As `encode_description`.

    """
    parts = [_branches(each, basis) for each, basis in zip(told, bases, strict=True)]
    arrays: dict[str, Array] = _joined(parts)
    trees: list[dict[str, str | int | float]] = []
    coordinates = key = 0
    blocks: list[list[int]] = []
    # Trees of one shape share a matrix, which is sent once.
    place_of: dict[int, int] = {}
    matrices: list[Array] = []
    for each, basis in zip(told, bases, strict=True):
        rows, columns = basis.matrix.shape
        if id(basis.matrix) not in place_of:
            place_of[id(basis.matrix)] = sum(len(matrix) for matrix in matrices)
            matrices.append(_float32(basis.matrix.ravel()))
        at = place_of[id(basis.matrix)]
        blocks.append([key, key + rows, coordinates, coordinates + columns, at])
        tree = each.tree
        trees.append(
            {
                "name": tree.name,
                "species": tree.species,
                "height": round(tree.height, 4),
                "branches": tree.n_branches,
                "segments": tree.n_segments,
                "coordinates": columns,
                "model": each.model,
                "basis_error": float(basis.error.greatest),
            }
        )
        coordinates, key = coordinates + columns, key + rows
    arrays["basis_block"] = np.array(blocks, dtype=np.int32)
    arrays["basis_matrix"] = np.concatenate(matrices)
    arrays["basis_scale"] = _float32(np.concatenate([basis.scale for basis in bases]))
    header: LeafyHeader = {
        "format": "tree_sway description",
        "name": simulator.tree.name,
        "frame_id": frame_id,
        "trees": trees,
        "branch_names": list(simulator.tree.branch_names),
    }
    if leaves is not None:
        header["flutter"] = {"gain": FLUTTER_GAIN, "largest_angle": LARGEST_ANGLE}
        arrays["leaf_segment"] = leaves.segment.astype(np.int32)
        arrays |= {
            "leaf_offset": _float32(leaves.offset),
            "leaf_orientation": _float32(leaves.orientation),
            "leaf_size": _float32(leaves.size),
            "leaf_frequency": _float32(leaves.frequency),
            "leaf_phase": _float32(leaves.phase),
        }
    return encode_description(header, arrays)


def _branches(simulator: ToldTree, told: ToldBasis) -> dict[str, Array]:
    """
    Arrays of one tree: how each branch of the whole tree is placed, by the told key rotations.

    """
    bank, tree = simulator.bank, simulator.tree
    arrays = _at_rest(tree)
    record_at = {int(first): i for i, first in enumerate(bank.branches["first"])}
    top_at: dict[int, int] = {}
    if bank.frozen is not None:
        top_at = {int(first): t for t, first in enumerate(bank.frozen.rows[:, 1])}
    turns: list[Floats] = []
    count = 0
    for branch, first in enumerate(tree.branch_first[:-1].tolist()):
        parent = int(tree.branch_parent[branch])
        carrier = record_at.get(int(tree.branch_first[parent])) if parent >= 0 else None
        if carrier is not None:
            moving = first in record_at
            base = (
                bank.branches[record_at[first]]["twist"][:, 3:]
                if moving
                else bank.frozen.base_turn[top_at[first]]
            )
            turns.append(told.per_key(carrier, base[: bank.branches[carrier]["n_coordinates"]]))
            arrays["branch_base_turn"][branch] = count
            count += len(turns[-1])
        if first not in record_at:
            continue
        at = record_at[first]
        record, here = bank.branches[at], tree.segments_of(branch)
        arrays["branch_frame"][branch] = told.frames[at]
        rows = slice(record["block"], record["block"] + here.stop - here.start)
        arrays["branch_coordinate"][branch] = record["coordinate"]
        arrays["branch_keys"][branch] = record["n_coordinates"]
        arrays["branch_skew"][branch] = record["skew"], record["tip_skew"]
        arrays["segment_slope"][here] = bank.segments["slope"][rows, record["lane"]]
        arrays["segment_tip_slope"][here] = bank.segments["tip_slope"][rows, record["lane"]]
        if record["n_coordinates"] > 2:
            arrays["branch_turn"][branch] = count
            for turn in turns_of_segments(record, bank.segments):
                turns.append(told.per_key(at, turn))
                count += len(turn)
    arrays["turn"] = _float32(np.concatenate([np.zeros((0, 3)), *turns]))
    return arrays


def _at_rest(tree: Tree) -> dict[str, Array]:
    """Arrays of a tree none of whose branches bends."""
    b, n = tree.n_branches, tree.n_segments
    rest = tree.rest_frame
    chord = np.empty((n, 3))
    chord[:-1] = tree.start[1:] - tree.start[:-1]
    last = tree.branch_first[1:] - 1
    chord[last] = tree.end[last] - tree.start[last]
    under = tree.segment_parent[tree.branch_first[:-1]]
    offset = tree.start[tree.branch_first[:-1]].copy()
    for branch in np.flatnonzero(under >= 0):
        w, x, y, z = rest[under[branch]]
        away = offset[branch] - tree.start[under[branch]]
        offset[branch] = rotated.py_func(w, -x, -y, -z, *away)  # type: ignore[attr-defined]
    return {
        "branch_parent": tree.branch_parent.astype(np.int32),
        "branch_base_segment": under.astype(np.int32),
        "branch_first": tree.branch_first[:-1].astype(np.int32),
        "branch_coordinate": np.full(b, RIGID, dtype=np.int32),
        "branch_keys": np.zeros(b, dtype=np.uint8),
        "branch_frame": np.zeros((b, 3, 3), dtype=np.float32),
        "branch_skew": np.zeros((b, 2), dtype=np.float32),
        "branch_base_turn": np.full(b, RIGID, dtype=np.int32),
        "branch_turn": np.full(b, RIGID, dtype=np.int32),
        "branch_offset": _float32(offset),
        "segment_slope": np.zeros(n, dtype=np.float32),
        "segment_tip_slope": np.zeros(n, dtype=np.float32),
        "segment_chord": _float32(chord),
        "segment_rest": _float32(rest),
        "segment_length": _float32(tree.length),
        "segment_radius": _float32(0.5 * np.stack([tree.base_diameter, tree.tip_diameter], axis=1)),
    }


def _joined(parts: list[dict[str, Array]]) -> dict[str, Array]:
    """Arrays of trees one after another, indices shifted."""
    branch = segment = coordinate = turn = 0
    for part in parts:
        for name, shift in (
            ("branch_parent", branch),
            ("branch_base_segment", segment),
            ("branch_coordinate", coordinate),
            ("branch_base_turn", turn),
            ("branch_turn", turn),
        ):
            part[name] = np.where(part[name] >= 0, part[name] + shift, part[name]).astype(np.int32)
        part["branch_first"] = part["branch_first"] + np.int32(segment)
        branch += len(part["branch_parent"])
        segment += len(part["segment_length"])
        coordinate += int(part["branch_keys"].sum(dtype=np.int64))
        turn += len(part["turn"])
    arrays = {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}
    arrays["branch_first"] = np.append(arrays["branch_first"], np.int32(segment)).astype(np.int32)
    return arrays


def _float32(values: ArrayLike) -> Array:
    return np.asarray(values, dtype=np.float32)
