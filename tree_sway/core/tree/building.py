# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
From segments in any order to a `Tree`: checks, inference of parents and branches, order.

The input is the paper's: start point, end point and thickness of each segment (Kanda & Ohya, 3.1).
Parents may be given; if not, the parent of a segment is the one that ends at its start. Branches
may be given; if not, the thickest child at the end of a segment continues its branch.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.core.arrays import Floats, Ints
from tree_sway.core.checks import refuse_named_columns
from tree_sway.core.tree.parents_first import chain_starts, checked_order, first_of_each
from tree_sway.core.tree.tree import Tree, tree_in_order
from tree_sway.errors import TreeError

_MAX_COORDINATE = 1e8
"""Largest coordinate of a node [m]: no map exceeds it, but files with wrong columns do."""


def tree_from_segments(
    start: ArrayLike, end: ArrayLike, diameter: ArrayLike, *, parent: ArrayLike | None = None,
    branch: ArrayLike | None = None, branch_names: Sequence[str] | None = None, name: str = 'tree',
    species: str = 'broadleaf', labels: Sequence[str] | None = None,
) -> Tree:  # fmt: skip
    """
    Build a tree from its segments.

    Parameters
    ----------
    start, end
        Root-side and tip-side node of each segment in [m], (n, 3).
    diameter
        Diameter of each segment in [m], (n,), or at its start and end, (n, 2).
    parent
        Parent of each segment, -1 for the root, (n,); inferred from the nodes if None.
    branch
        Branch key of each segment, any integers, (n,); inferred if None. Segments of one branch
        must be one chain.
    branch_names
        Names by sorted branch key; ``stem``, ``b1`` ... in depth-first order if None.
    name, species
        Name of the tree, and key of its species.
    labels
        Names of the segments in errors, for example ``line 12``; their numbers if None.

    Returns
    -------
    Tree
        Tree with segments and branches in depth-first order.

    Raises
    ------
    TreeError
        Wrong shapes, numbers that are not finite, a segment without length or thickness, a parent
        that does not exist, a cycle, more than one root, a branch that is not a chain.

    """
    starts = _numbers('start', start)
    ends = _numbers('end', end)
    diameters = _numbers('diameter', diameter)
    if diameters.ndim == 1:
        diameters = np.stack([diameters, diameters], axis=1)
    n = len(starts)
    called = labels if labels is not None else [f'segment {index}' for index in range(n)]
    _check_geometry(starts, ends, diameters, called)
    if parent is None:
        parents = _parents_by_nodes(starts, ends)
    else:
        parents = _integers(parent, n, 'parent')
    depth_order = checked_order(parents, called)
    _refuse_further_roots(parents, called)
    if branch is None:
        continuations = _continuations(starts, ends, diameters, parents, depth_order)
        keys = chain_starts(parents, continuations)
    else:
        keys = _integers(branch, n, 'branch')
    chains = _chains(keys, parents, depth_order, called)
    ordered = _depth_first(chains, parents)
    names = _names(branch_names, ordered)
    chains = [chains[number] for number in ordered]
    order = np.concatenate(chains).astype(np.int64)
    branch_first = np.concatenate([[0], np.cumsum([len(chain) for chain in chains])])
    return tree_in_order(
        start=starts[order],
        end=ends[order],
        base_diameter=diameters[order, 0],
        tip_diameter=diameters[order, 1],
        segment_parent=_renumbered(parents, order),
        branch_first=branch_first.astype(np.int64),
        source_index=order,
        branch_names=names,
        name=name,
        species=species,
    )


def _refuse_further_roots(parents: Ints, labels: Sequence[str]) -> None:
    roots = np.flatnonzero(parents == -1)
    if len(roots) > 1:
        raise TreeError(
            f'{len(roots)} roots: a forest of trees that are not connected, or orphans',
            where=labels[roots[1]],
            cure=f'give it a parent, as only {labels[roots[0]]} may be the root, or make '
            'each tree its own',
        )


def _names(given: Sequence[str] | None, ordered: Sequence[int]) -> tuple[str, ...]:
    """Return the names of the branches, whose numbers by key are in depth-first order."""
    if given is None:
        return ('stem', *(f'b{number}' for number in range(1, len(ordered))))
    if len(given) != len(ordered):
        raise TreeError(f'{len(given)} branch names for {len(ordered)} branches')
    return tuple(given[number] for number in ordered)


def _renumbered(parents: Ints, order: Ints) -> Ints:
    """Return the parents of segments in a new order, by their new numbers."""
    position = np.empty(len(order), dtype=np.int64)
    position[order] = np.arange(len(order))
    return np.where(parents[order] < 0, -1, position[parents[order]]).astype(np.int64)


def _numbers(what: str, values: ArrayLike) -> Floats:
    """Return a copy of values as an array; a `TreeError` if they are no array of numbers."""
    refuse_named_columns(what, values)
    try:
        numbers = np.array(values, dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        cure = 'give an array of numbers, a row for each segment'
        raise TreeError('not an array of numbers', where=what, cure=cure) from None
    if numbers.ndim not in (1, 2):
        raise TreeError(f'{numbers.ndim} dimensions', where=what, cure='give (n, 3), or (n,)')
    return numbers


def _check_geometry(
    starts: Floats, ends: Floats, diameters: Floats, labels: Sequence[str]
) -> None:
    n = len(starts)
    if n == 0:
        raise TreeError('a tree without segments', cure='give at least one segment')
    if starts.shape != (n, 3) or ends.shape != (n, 3) or diameters.shape != (n, 2):
        raise TreeError(
            f'start {starts.shape}, end {ends.shape} and diameter {diameters.shape} do not match',
            cure='give (n, 3), (n, 3) and (n,) or (n, 2)',
        )
    check_numbers(np.hstack([starts, ends, diameters]), labels)
    length = np.linalg.norm(ends - starts, axis=1)
    for index in np.flatnonzero(length < 1e-9)[:1]:
        what = f'zero length (start and end are both {starts[index].tolist()})'
        raise TreeError(what, where=labels[index], cure='remove the segment or move its end')
    for index in np.flatnonzero((diameters <= 0.0).any(axis=1))[:1]:
        what = f'diameter {diameters[index].tolist()} m is not positive'
        cure = 'give a diameter above 0; a pointed tip may have 0.0001 m'
        raise TreeError(what, where=labels[index], cure=cure)


def check_numbers(rows: Floats, labels: Sequence[str]) -> None:
    """Raise a `TreeError` for the first row (n, k) that is not finite or too large."""
    for index in np.flatnonzero(~(np.abs(rows) <= _MAX_COORDINATE).all(axis=1))[:1]:
        what = 'too large for metres' if np.isfinite(rows[index]).all() else 'that is not finite'
        raise TreeError(
            f'a number {what}: {rows[index].tolist()}',
            where=labels[index],
            cure='check the order of the columns and their unit, metres',
        )


def _integers(values: ArrayLike, n: int, what: str) -> Ints:
    """Return values as an array (n,); a `TreeError` if they are not n integers."""
    try:
        array = np.asarray(values)
    except ValueError:  # rows of different lengths
        raise TreeError(f'{what} must be {n} integers, not a list of lists') from None
    if array.shape != (n,) or not np.issubdtype(array.dtype, np.integer):
        raise TreeError(f'{what} must be {n} integers, not {array.shape} of {array.dtype}')
    return array.astype(np.int64)


def _parents_by_nodes(starts: Floats, ends: Floats) -> Ints:
    """Find the segment that ends nearest to the start of each, within 1e-4 of the size."""
    from scipy.spatial import cKDTree  # it takes long to load, and most files name parents

    extent = float(np.ptp(np.vstack([starts, ends]), axis=0).max())
    # Two neighbours, since the end nearest to the start of a very short root is its own.
    distance, index = cKDTree(ends).query(starts, k=2, distance_upper_bound=1e-4 * extent)
    distance[index == np.arange(len(starts))[:, None]] = np.inf
    nearest = np.argmin(distance, axis=1)[:, None]
    found = np.isfinite(np.take_along_axis(distance, nearest, axis=1))
    parents = np.where(found, np.take_along_axis(index, nearest, axis=1), -1)[:, 0]
    return parents.astype(np.int64)


def _continuations(
    starts: Floats, ends: Floats, diameters: Floats, parents: Ints, depth_order: Ints
) -> Ints:
    """Return the continuation of each segment: the thickest child, or the straightest, (n,)."""
    rank = np.empty(len(parents), dtype=np.int64)
    rank[depth_order] = np.arange(len(parents))
    axis = ends - starts
    length = np.linalg.norm(axis, axis=1)
    gap = np.linalg.norm(starts - ends[parents], axis=1)
    may = np.flatnonzero((parents >= 0) & (gap <= 0.5 * length[parents]))
    direction = axis[may] / length[may, None]
    above = axis[parents[may]] / length[parents[may], None]
    straight = np.array([one @ other for one, other in zip(direction, above, strict=True)])
    return first_of_each(parents, may, -diameters[may, 0], -straight, rank[may])


def _chains(keys: Ints, parents: Ints, depth_order: Ints, labels: Sequence[str]) -> list[Ints]:
    """Segments of each branch from base to tip, in the order of keys."""
    by_key = depth_order[np.argsort(keys[depth_order], kind='stable')]
    has_predecessor = keys[by_key[1:]] == keys[by_key[:-1]]
    broken = by_key[1:][has_predecessor & (parents[by_key[1:]] != by_key[:-1])]
    for segment in depth_order[np.isin(depth_order, broken)][:1]:
        what = f'branch {keys[segment]} is not one chain: the segment before is not its parent'
        cure = 'give the side shoot its own branch'
        raise TreeError(what, where=labels[segment], cure=cure)
    return np.split(by_key, np.flatnonzero(~has_predecessor) + 1)


def _depth_first(chains: Sequence[Ints], parents: Ints) -> list[int]:
    """Numbers of branches in depth-first order; siblings from base to tip of their parent."""
    place = np.empty(len(parents), dtype=np.int64)
    owner = np.empty(len(parents), dtype=np.int64)
    for number, chain in enumerate(chains):
        place[chain] = np.arange(len(chain))
        owner[chain] = number
    first = np.array([chain[0] for chain in chains])
    children: dict[int, list[int]] = {}
    for number in np.lexsort((first, place[parents[first]]))[::-1].tolist():
        base = parents[first[number]]
        children.setdefault(-1 if base < 0 else int(owner[base]), []).append(number)
    ordered = list[int]()
    stack = children[-1]
    while stack:
        ordered.append(stack.pop())
        stack.extend(children.get(ordered[-1], ()))
    return ordered
