# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
What a receiver needs to rebuild every pose from a frame.

Of each kind of tree it is the rest geometry, how its branches bend, and the basis of its state; of
each tree its kind, and where it stands.

A branch that moves with its parent as one body has no coordinate, and slopes of 0. A kind stands
with its root node at the origin.
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
from tree_sway_ros.core.simulator.protocol import TreeSimulator
from tree_sway_ros.core.tree.tree import Tree
from tree_sway_ros.page.protocol import (
    Array,
    encode_description,
    LeafyHeader,
    ToldPlace,
    ToldShape,
)
from tree_sway_ros.page.told_kind import ToldKind

RIGID = -1
"""Coordinate of a branch that has none."""


def describe_scene(
    name: str,
    kinds: Sequence[ToldKind],
    tree_names: Sequence[str],
    *,
    frame_id: str = 'map',
    leaves: Sequence[LeafClusters | None] = (),
) -> bytes:
    """
    Describe a tree or a forest for receivers of its state.

    Parameters
    ----------
    name
        Of the scene.
    kinds
        Its trees by kind.
    tree_names
        A name per tree.
    frame_id
        Frame of the poses.
    leaves
        Clusters of leaves of each kind; none if empty.

    Returns
    -------
    bytes
        As `encode_description`.

    """
    places = np.zeros((len(tree_names), 5), dtype=np.float32)
    kind_of = np.zeros(len(tree_names), dtype=np.int64)
    told: list[ToldShape] = []
    arrays: dict[str, Array] = {'tree_place': places}
    for number, kind in enumerate(kinds):
        places[kind.numbers], kind_of[kind.numbers] = kind.places, number
        own, tree = _branches(kind.simulator), kind.simulator.tree
        own['basis_matrix'] = _float32(kind.basis.matrix)
        own['basis_scale'] = _float32(kind.basis.scale)
        clusters = leaves[number] if leaves else None
        if clusters is not None:
            own['leaf_segment'] = clusters.segment.astype(np.int32)
            own |= {
                'leaf_offset': _float32(clusters.offset),
                'leaf_orientation': _float32(clusters.orientation),
                'leaf_size': _float32(clusters.size),
                'leaf_frequency': _float32(clusters.frequency),
                'leaf_phase': _float32(clusters.phase),
            }
        arrays |= {f'{number}/{field}': array for field, array in own.items()}
        told.append(
            {
                'species': tree.species,
                'height': round(tree.height, 4),
                'model': kind.simulator.model,
                'basis_error': float(kind.basis.error.greatest),
                'branch_names': list(tree.branch_names),
            }
        )
    trees: list[ToldPlace] = [
        {'name': each, 'kind': kind}
        for each, kind in zip(tree_names, kind_of.tolist(), strict=True)
    ]
    header: LeafyHeader = {
        'format': 'tree_sway description',
        'name': name,
        'frame_id': frame_id,
        'kinds': told,
        'trees': trees,
    }
    if any(each is not None for each in leaves):
        header['flutter'] = {'gain': FLUTTER_GAIN, 'largest_angle': LARGEST_ANGLE}
    return encode_description(header, arrays)


def _branches(simulator: TreeSimulator) -> dict[str, Array]:
    """Arrays of one kind: how each branch of the whole tree is placed, by the key rotations."""
    bank, tree = simulator.bank, simulator.tree
    arrays = _at_rest(tree)
    record_at = {int(first): i for i, first in enumerate(bank.branches['first'])}
    top_at: dict[int, int] = {}
    if bank.frozen is not None:
        top_at = {int(first): t for t, first in enumerate(bank.frozen.rows[:, 1])}
    turns: list[Floats] = []
    count = 0
    for branch, first in enumerate(tree.branch_first[:-1].tolist()):
        parent = int(tree.branch_parent[branch])
        carrier = record_at.get(int(tree.branch_first[parent])) if parent >= 0 else None
        if carrier is not None:
            if first in record_at or bank.frozen is None:
                base = bank.branches[record_at[first]]['twist'][:, 3:]
            else:
                base = bank.frozen.base_turn[top_at[first]]
            turns.append(base[: bank.branches[carrier]['n_coordinates']])
            arrays['branch_base_turn'][branch] = count
            count += len(turns[-1])
        if first not in record_at:
            continue
        at = record_at[first]
        record, here = bank.branches[at], tree.segments_of(branch)
        arrays['branch_frame'][branch] = bank.branches['frame'][at]
        rows = slice(record['block'], record['block'] + here.stop - here.start)
        arrays['branch_coordinate'][branch] = record['coordinate']
        arrays['branch_keys'][branch] = record['n_coordinates']
        arrays['branch_skew'][branch] = record['skew'], record['tip_skew']
        arrays['segment_slope'][here] = bank.segments['slope'][rows, record['lane']]
        arrays['segment_tip_slope'][here] = bank.segments['tip_slope'][rows, record['lane']]
        if record['n_coordinates'] > 2:
            arrays['branch_turn'][branch] = count
            for turn in turns_of_segments(record, bank.segments):
                turns.append(turn)
                count += len(turn)
    arrays['turn'] = _float32(np.concatenate([np.zeros((0, 3)), *turns]))
    return arrays


def _at_rest(tree: Tree) -> dict[str, Array]:
    """Arrays of a kind none of whose branches bends."""
    b, n = tree.n_branches, tree.n_segments
    rest = tree.rest_frame
    chord = np.empty((n, 3))
    chord[:-1] = tree.start[1:] - tree.start[:-1]
    last = tree.branch_first[1:] - 1
    chord[last] = tree.end[last] - tree.start[last]
    under = tree.segment_parent[tree.branch_first[:-1]]
    offset = tree.start[tree.branch_first[:-1]] - tree.start[0]
    for branch in np.flatnonzero(under >= 0):
        w, x, y, z = rest[under[branch]]
        away = tree.start[tree.branch_first[branch]] - tree.start[under[branch]]
        offset[branch] = rotated.py_func(w, -x, -y, -z, *away)  # type: ignore[attr-defined]
    return {
        'branch_parent': tree.branch_parent.astype(np.int32),
        'branch_base_segment': under.astype(np.int32),
        'branch_first': tree.branch_first.astype(np.int32),
        'branch_coordinate': np.full(b, RIGID, dtype=np.int32),
        'branch_keys': np.zeros(b, dtype=np.uint8),
        'branch_frame': np.zeros((b, 3, 3), dtype=np.float32),
        'branch_skew': np.zeros((b, 2), dtype=np.float32),
        'branch_base_turn': np.full(b, RIGID, dtype=np.int32),
        'branch_turn': np.full(b, RIGID, dtype=np.int32),
        'branch_offset': _float32(offset),
        'segment_slope': np.zeros(n, dtype=np.float32),
        'segment_tip_slope': np.zeros(n, dtype=np.float32),
        'segment_chord': _float32(chord),
        'segment_rest': _float32(rest),
        'segment_length': _float32(tree.length),
        'segment_radius': _float32(
            0.5 * np.stack([tree.base_diameter, tree.tip_diameter], axis=1)
        ),
    }


def _float32(values: ArrayLike) -> Array:
    return np.asarray(values, dtype=np.float32)
