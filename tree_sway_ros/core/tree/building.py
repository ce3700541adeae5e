# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
From segments in any order to a `Tree`: check, infer what is missing, group, order depth-first.

The input is the paper's: start point, end point and thickness of each segment (Kanda & Ohya, 3.1).
Parents may be given; if not, a segment sits on the one whose end node is where it starts. Branches
may be given; if not, the thickest child that goes on from a segment's end continues its branch.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tree_sway_ros.core.arrays import Floats, Ints
from tree_sway_ros.core.tree.parents_first import parents_first
from tree_sway_ros.core.tree.tree import Tree
from tree_sway_ros.errors import TreeError


def tree_from_segments(
    start: ArrayLike,
    end: ArrayLike,
    diameter: ArrayLike,
    *,
    parent: ArrayLike | None = None,
    branch: ArrayLike | None = None,
    branch_names: Sequence[str] | None = None,
    name: str = 'tree',
    species: str = 'broadleaf',
    labels: Sequence[str] | None = None,
) -> Tree:
    """
    Build a tree from its segments.

    Parameters
    ----------
    start, end
        Root-side and tip-side node of each segment in [m], (n, 3).
    diameter
        Diameter of each segment in [m], (n,), or at its start and end, (n, 2).
    parent
        Segment that each one sits on, -1 for the root, (n,); inferred from the nodes if None.
    branch
        Branch key of each segment, any integers, (n,); inferred if None. Segments of one branch
        must be one chain.
    branch_names
        Names by sorted branch key; ``stem``, ``b1`` ... in depth-first order if None.
    name, species
        What the tree is called, and the key of its wood.
    labels
        How errors call each segment, for example ``line 12``; its number if None.

    Returns
    -------
    Tree
        With segments and branches in depth-first order.

    Raises
    ------
    TreeError
        Wrong shapes, numbers that are not finite, a segment of no length or no thickness, a
        parent that does not exist, a cycle, more than one root, a branch that is not a chain.

    """
    starts, ends, diameters = _checked_geometry(start, end, diameter, labels)
    n = len(starts)
    if parent is None:
        parents = _parents_by_nodes(starts, ends)
    else:
        parents = _integers(parent, n, 'parent')
    depth_order = _checked_parents(parents, labels)
    if branch is None:
        keys = _branches_by_continuation(starts, ends, diameters, parents, depth_order)
    else:
        keys = _integers(branch, n, 'branch')
    chains = _chains(keys, parents, depth_order, labels)
    ordered = _depth_first(chains, keys, parents)

    order = np.concatenate([chains[key] for key in ordered])
    position = np.empty(n, dtype=np.int64)
    position[order] = np.arange(n)
    segment_parent = np.where(parents[order] < 0, -1, position[parents[order]])
    counts = [len(chains[key]) for key in ordered]
    branch_first = np.concatenate([[0], np.cumsum(counts)]).astype(np.int64)
    owner = np.repeat(np.arange(len(ordered)), counts)
    base_parent = segment_parent[branch_first[:-1]]
    branch_parent = np.where(base_parent < 0, -1, owner[base_parent]).astype(np.int64)
    names = _names(ordered, branch_names)
    return Tree(
        start=starts[order],
        end=ends[order],
        base_diameter=diameters[order, 0],
        tip_diameter=diameters[order, 1],
        segment_parent=segment_parent.astype(np.int64),
        branch_first=branch_first,
        branch_parent=branch_parent,
        subtree_end=_subtree_end(branch_parent),
        source_index=order.astype(np.int64),
        branch_names=names,
        name=name,
        species=species,
    )


def _label(index: int, labels: Sequence[str] | None) -> str:
    return labels[index] if labels is not None else f'segment {index}'


def _checked_geometry(
    start: ArrayLike, end: ArrayLike, diameter: ArrayLike, labels: Sequence[str] | None
) -> tuple[Floats, Floats, Floats]:
    starts = np.array(start, dtype=np.float64)
    ends = np.array(end, dtype=np.float64)
    diameters = np.array(diameter, dtype=np.float64)
    if diameters.ndim == 1:
        diameters = np.stack([diameters, diameters], axis=1)
    n = len(starts)
    if n == 0:
        raise TreeError('a tree of no segments', cure='give at least one segment')
    if starts.shape != (n, 3) or ends.shape != (n, 3) or diameters.shape != (n, 2):
        raise TreeError(
            f'start {starts.shape}, end {ends.shape} and diameter {diameters.shape} do not match',
            cure='give (n, 3), (n, 3) and (n,) or (n, 2)',
        )
    everything = np.hstack([starts, ends, diameters])
    for index in np.flatnonzero(~np.isfinite(everything).all(axis=1))[:1]:
        raise TreeError(
            f'a number that is not finite: {everything[index].tolist()}',
            where=_label(int(index), labels),
            cure='give start, end and diameter as finite numbers in metres',
        )
    length = np.linalg.norm(ends - starts, axis=1)
    for index in np.flatnonzero(length < 1e-9)[:1]:
        raise TreeError(
            f'zero length (start and end are both {starts[index].tolist()})',
            where=_label(int(index), labels),
            cure='remove the segment or move its end',
        )
    for index in np.flatnonzero((diameters <= 0.0).any(axis=1))[:1]:
        raise TreeError(
            f'diameter {diameters[index].tolist()} m is not positive',
            where=_label(int(index), labels),
            cure='give a diameter above 0; a pointed tip may be .0001',
        )
    return starts, ends, diameters


def _integers(values: ArrayLike, n: int, what: str) -> Ints:
    array = np.asarray(values)
    if array.shape != (n,) or not np.issubdtype(array.dtype, np.integer):
        raise TreeError(f'{what} must be {n} integers, not {array.shape} of {array.dtype}')
    return array.astype(np.int64)


def _parents_by_nodes(starts: Floats, ends: Floats) -> Ints:
    """Sit each segment on the one whose end is nearest to its start, within 1e-4 of the size."""
    from scipy.spatial import cKDTree  # it takes long to load, and most files name parents

    extent = float(np.ptp(np.vstack([starts, ends]), axis=0).max())
    # Two are asked for, as the end nearest to the start of a very short root is its own.
    distance, index = cKDTree(ends).query(starts, k=2, distance_upper_bound=1e-4 * extent)
    distance[index == np.arange(len(starts))[:, None]] = np.inf
    nearest = np.argmin(distance, axis=1)[:, None]
    found = np.isfinite(np.take_along_axis(distance, nearest, axis=1))
    parents = np.where(found, np.take_along_axis(index, nearest, axis=1), -1)[:, 0]
    return parents.astype(np.int64)


def _checked_parents(parents: Ints, labels: Sequence[str] | None) -> Ints:
    """Return segments in an order where parents come first, or say what is wrong."""
    n = len(parents)
    for index in np.flatnonzero((parents < -1) | (parents >= n))[:1]:
        raise TreeError(
            f'orphan: its parent {parents[index]} does not exist',
            where=_label(int(index), labels),
            cure=f'name a parent from 0 to {n - 1}, or -1 for the root',
        )
    roots = np.flatnonzero(parents == -1)
    if len(roots) > 1:
        raise TreeError(
            f'{len(roots)} roots: a forest of trees that are not connected, or orphans',
            where=_label(int(roots[1]), labels),
            cure=f'give it a parent, as only {_label(int(roots[0]), labels)} may stand on the '
            f'ground, '
            'or make each tree its own',
        )
    order = parents_first(parents.tolist())
    if len(order) < n:
        lost = int(np.setdiff1d(np.arange(n), order)[0])
        raise TreeError(
            'cyclic: following its parents never reaches a root',
            where=_label(lost, labels),
            cure='break the cycle; exactly one segment has parent -1',
        )
    return np.array(order, dtype=np.int64)


def _branches_by_continuation(
    starts: Floats, ends: Floats, diameters: Floats, parents: Ints, depth_order: Ints
) -> Ints:
    """Follow each branch through its nodes: on to the thickest child, the straightest on a tie."""
    n = len(parents)
    direction = ends - starts
    direction /= np.linalg.norm(direction, axis=1)[:, None]
    heir = np.full(n, -1, dtype=np.int64)
    best: dict[int, tuple[float, float]] = {}
    for child in depth_order:
        its_parent = int(parents[child])
        if its_parent < 0 or np.linalg.norm(
            starts[child] - ends[its_parent]
        ) > 0.5 * np.linalg.norm(ends[its_parent] - starts[its_parent]):
            continue
        rank = (float(diameters[child, 0]), float(direction[child] @ direction[its_parent]))
        if its_parent not in best or rank > best[its_parent]:
            best[its_parent], heir[its_parent] = rank, child
    keys = np.full(n, -1, dtype=np.int64)
    next_key = 0
    for segment in depth_order:
        its_parent = int(parents[segment])
        if its_parent >= 0 and heir[its_parent] == segment:
            keys[segment] = keys[its_parent]
        else:
            keys[segment] = next_key
            next_key += 1
    return keys


def _chains(
    keys: Ints, parents: Ints, depth_order: Ints, labels: Sequence[str] | None
) -> dict[int, NDArray[np.int64]]:
    """Segments of each branch from base to tip."""
    members: dict[int, list[int]] = {}
    for segment in depth_order:
        chain = members.setdefault(int(keys[segment]), [])
        if chain and parents[segment] != chain[-1]:
            raise TreeError(
                f'branch {keys[segment]} is not one chain: the segment before is not its parent',
                where=_label(int(segment), labels),
                cure='give the side shoot a branch of its own',
            )
        chain.append(int(segment))
    return {key: np.array(chain, dtype=np.int64) for key, chain in members.items()}


def _depth_first(chains: dict[int, NDArray[np.int64]], keys: Ints, parents: Ints) -> list[int]:
    """Branch keys in depth-first order; siblings from base to tip of their parent."""
    place = {int(s): i for chain in chains.values() for i, s in enumerate(chain)}
    children: dict[int, list[tuple[int, int, int]]] = {key: [] for key in chains}
    stack = []
    for key, chain in chains.items():
        base = int(parents[chain[0]])
        if base < 0:
            stack.append(key)
        else:
            children[int(keys[base])].append((place[base], int(chain[0]), key))
    ordered = []
    while stack:
        key = stack.pop()
        ordered.append(key)
        stack.extend(child for _, _, child in sorted(children[key], reverse=True))
    return ordered


def _names(ordered: list[int], branch_names: Sequence[str] | None) -> tuple[str, ...]:
    if branch_names is None:
        return tuple('stem' if i == 0 else f'b{i}' for i in range(len(ordered)))
    if len(branch_names) != len(ordered):
        raise TreeError(f'{len(branch_names)} branch names for {len(ordered)} branches')
    by_key = dict(zip(sorted(ordered), branch_names, strict=True))
    return tuple(by_key[key] for key in ordered)


def _subtree_end(branch_parent: Ints) -> Ints:
    end = np.arange(1, len(branch_parent) + 1, dtype=np.int64)
    for branch in range(len(branch_parent) - 1, 0, -1):
        its_parent = branch_parent[branch]
        end[its_parent] = max(end[its_parent], end[branch])
    return end
