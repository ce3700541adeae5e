# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Order in which parents come before their children."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.core.arrays import Floats, Ints
from tree_sway.errors import TreeError


def parents_first(parents: Iterable[int]) -> list[int]:
    """
    Order the numbers of a tree from its roots (negative parents) on, generation by generation.

    Members of a cycle are left out.
    """
    children: dict[int, list[int]] = {}
    for number, parent in enumerate(parents):
        children.setdefault(max(parent, -1), []).append(number)
    order = list(children.get(-1, ()))
    for number in order:
        order.extend(children.get(number, ()))
    return order


def checked_order(parents: ArrayLike, labels: Sequence[str]) -> Ints:
    """
    Order all numbers as `parents_first`; labels are their names in errors.

    A `TreeError` reports a parent that does not exist, or a cycle.
    """
    above = np.asarray(parents, dtype=np.int64)
    n = len(labels)
    for index in np.flatnonzero((above < -1) | (above >= n))[:1]:
        what = f'orphan: its parent {above[index]} does not exist'
        cure = f'give a parent from 0 to {n - 1}, or -1 for the root'
        raise TreeError(what, where=labels[index], cure=cure)
    order = np.array(parents_first(above.tolist()), dtype=np.int64)
    for lost in np.setdiff1d(np.arange(n), order)[:1]:
        what = 'cyclic: following its parents never reaches a root'
        cure = 'break the cycle; the root has no parent, or -1'
        raise TreeError(what, where=labels[lost], cure=cure)
    return order


def first_of_each(parents: Ints, candidates: Ints, *ranks: Floats | Ints) -> Ints:
    """Return the candidate of lowest rank on each parent, -1 without any, (n,)."""
    by_rank = candidates[np.lexsort((*ranks[::-1], parents[candidates]))]
    found = np.full(len(parents), -1, dtype=np.int64)
    above, first = np.unique(parents[by_rank], return_index=True)
    found[above] = by_rank[first]
    return found


def chain_starts(parents: Ints, continuations: Ints) -> Ints:
    """Return the first member of the chain of each, along continuations, (n,)."""
    number = np.arange(len(parents))
    start = np.where((parents >= 0) & (continuations[parents] == number), parents, number)
    while not np.array_equal(start[start], start):
        start = start[start]
    return start.astype(np.int64)
