# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Description of a scene, by which a receiver computes every pose from a frame.

For each kind of tree it has the rest geometry, the bending of its branches, and the basis of its
state; for each tree its kind and place.

A kind has its root node at the origin.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.core.arrays import Floats, Records
from tree_sway.core.leaves import FLUTTER, LeafClusters
from tree_sway.core.run import SwaySimulator
from tree_sway.stream.check_description import Array, Arrays
from tree_sway.stream.protocol import encode_description
from tree_sway.stream.scene_kind import SceneKind

_NO_ROW = -1
"""Row of the rotations of a branch without a parent, or one that bends by its slope."""


def describe_scene(
    name: str,
    kinds: Sequence[SceneKind],
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
        Name of the scene.
    kinds
        Kinds of its trees.
    tree_names
        Names of the trees.
    frame_id
        Frame of the poses.
    leaves
        Clusters of leaves of each kind; none if empty.

    Returns
    -------
    bytes
        Message of `encode_description`.

    """
    places = np.zeros((len(tree_names), 5), dtype=np.float32)
    kind_of = np.zeros(len(tree_names), dtype=np.int64)
    entries = []
    arrays: Arrays = {'tree_place': places}
    for number, kind in enumerate(kinds):
        places[kind.numbers] = kind.places
        kind_of[kind.numbers] = number
        own = _branches(kind.simulator)
        tree = kind.simulator.tree
        wood = kind.simulator.models[0].species
        own['basis_matrix'] = _float32(kind.basis.matrix)
        own['basis_scale'] = _float32(kind.basis.scale)
        clusters = leaves[number] if leaves else None
        if clusters is not None:
            own['leaf_segment'] = clusters.segment.astype(np.int32)
            for field in ('offset', 'orientation', 'size', 'frequency', 'phase'):
                own[f'leaf_{field}'] = _float32(getattr(clusters, field))
        arrays |= {f'{number}/{field}': array for field, array in own.items()}
        entries.append(
            {
                'species': tree.species,
                'look': wood.look.described(wood.leaves, wood.habit),
                'height': round(tree.height, 4),
                'model': kind.simulator.model,
                'basis_error': kind.basis.error,
                'modulus': wood.modulus,
                'branch_names': _names(kind.simulator),
            }
        )
    trees = [
        {'name': each, 'kind': kind}
        for each, kind in zip(tree_names, kind_of.tolist(), strict=True)
    ]
    header: dict[str, object] = {
        'format': 'tree_sway description',
        'name': name,
        'frame_id': frame_id,
        'kinds': entries,
        'trees': trees,
    }
    if any(each is not None for each in leaves):
        header['flutter'] = FLUTTER
    return encode_description(header, arrays)


def _branches(simulator: SwaySimulator) -> Arrays:
    """Arrays of one kind for placing its branches by key rotations."""
    tree = simulator.tree
    model = simulator.models[0]
    branches = _in_order(simulator)
    keys = branches['n_coordinates']
    sizes = branches['end'] - branches['first']
    base_turn, own_turn = np.full((2, len(branches)), _NO_ROW, dtype=np.int32)
    turns: list[Floats] = [np.zeros((0, 3))]
    count = 0
    for branch, record in enumerate(branches):
        if record['parent'] >= 0:
            base_turn[branch] = count
            turns.append(record['twist'][: keys[record['parent']], 3:])
            count += len(turns[-1])
        if keys[branch] > 2:
            own_turn[branch] = count
            own = slice(record['first'], record['end'])
            turns.append(model.segment_turn[own, : keys[branch]].reshape(-1, 3))
            count += len(turns[-1])
    first = np.cumsum([0, *sizes])
    indices = {
        'branch_parent': branches['parent'],
        'branch_base_segment': branches['base_segment'],
        'branch_first': first,
        'branch_coordinate': branches['coordinate'],
        'branch_base_turn': base_turn,
        'branch_turn': own_turn,
    }
    diameter = np.stack([tree.base_diameter, tree.tip_diameter], axis=1)
    numbers = {
        'branch_frame': branches['frame'],
        'branch_skew': model.branch_skew,
        'branch_offset': np.where(branches['parent'][:, None] < 0, 0.0, branches['offset']),
        'segment_slope': model.segment_slope,
        'segment_tip_slope': model.segment_tip_slope,
        'segment_chord': model.segment_chord,
        'segment_rest': model.segment_rest,
        'segment_length': tree.length,
        'segment_radius': 0.5 * diameter,
        'turn': np.concatenate(turns),
    }
    return {
        **{name: array.astype(np.int32) for name, array in indices.items()},
        'branch_keys': keys.astype(np.uint8),
        **{name: _float32(array) for name, array in numbers.items()},
    }


def _in_order(simulator: SwaySimulator) -> Records:
    """
    Return the branches, their segments in the order of the tree.

    A branch that is cut is several, and the children of its first piece come before the second.
    """
    branches = simulator.banks[0].branches
    order = np.argsort(branches['first'])
    ordered = branches[order]
    place = np.argsort(order)
    ordered['parent'] = np.where(ordered['parent'] < 0, -1, place[ordered['parent']])
    return ordered


def _names(simulator: SwaySimulator) -> list[str]:
    """Names of the branches; pieces of a branch that is cut have its name."""
    tree = simulator.tree
    whole = tree.branch_of_segment[_in_order(simulator)['first']]
    return [tree.branch_names[branch] for branch in whole.tolist()]


def _float32(values: ArrayLike) -> Array:
    return np.asarray(values, dtype=np.float32)
