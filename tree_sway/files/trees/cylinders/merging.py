# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Merge cylinders too short to have a direction into their neighbours of the same branch."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.arrays import Floats, Ints
from tree_sway.files.trees.cylinders.cylinders import Cylinders
from tree_sway.files.trees.cylinders.joining import continuations


class MergedCylinders(NamedTuple):
    """Cylinders without the tiny ones; how many those were, and how many a branch on their own."""

    cylinders: Cylinders
    tiny: int = 0
    dropped: int = 0


def merge_tiny(cylinders: Cylinders, order: list[int], below: float) -> MergedCylinders:
    """
    Merge cylinders of one tree, parents first in ``order``, that are below a length in [m].

    A tiny one goes to the cylinder before it in its branch, which is drawn out to its end; the
    first of a branch to the one after it. The volume is kept. What grew on it grows on the other.
    """
    tiny = np.linalg.norm(cylinders.end - cylinders.start, axis=1) < max(below, 1e-9)
    if not tiny.any() or tiny.all():
        return MergedCylinders(cylinders)
    start, end, diameter = cylinders.start.copy(), cylinders.end.copy(), cylinders.diameter.copy()
    parent, continuation = cylinders.parent.copy(), continuations(cylinders)
    has_predecessor = np.zeros(len(parent), dtype=np.bool_)
    has_predecessor[continuation[continuation >= 0]] = True
    # The cylinder that one that is gone was merged into.
    merged_into = np.arange(len(parent))
    dropped = 0
    for index in order:
        above = parent[index] = merged_into[parent[index]] if parent[index] >= 0 else -1
        if not tiny[index]:
            continue
        after = int(continuation[index])
        if has_predecessor[index] and above >= 0:
            _merge(start, end, diameter, int(above), index, start[above], end[index])
            merged_into[index] = above
        elif after >= 0:
            _merge(start, end, diameter, after, index, start[index], end[after])
            # Its other children come to stand on the one after it, which takes its own parent.
            merged_into[index] = after
            parent[after] = above
            tiny[after] = np.linalg.norm(end[after] - start[after]) < max(below, 1e-9)
            has_predecessor[after] = False
        elif above >= 0:
            merged_into[index] = above
            dropped += 1
        else:  # a root on which only side branches grow: it stays, and the core will complain
            tiny[index] = False
    moved = replace(cylinders, start=start, end=end, diameter=diameter, parent=parent)
    remaining = _remaining(moved, ~tiny, has_predecessor, merged_into)
    return MergedCylinders(remaining, int(tiny.sum()), dropped)


def _merge(
    start: Floats,
    end: Floats,
    diameter: Floats,
    kept: int,
    gone: int,
    begin: Floats,
    finish: Floats,
) -> None:
    volume = _volume(start, end, diameter, kept) + _volume(start, end, diameter, gone)
    start[kept], end[kept] = begin.copy(), finish.copy()
    after = _volume(start, end, diameter, kept)
    if after > 0.0 and volume > 0.0:
        diameter[kept] *= np.sqrt(volume / after)


def _volume(start: Floats, end: Floats, diameter: Floats, index: int) -> float:
    """Volume of one cone in [m^3], but for the constant factor."""
    d0, d1 = diameter[index]
    return float(np.linalg.norm(end[index] - start[index]) * (d0 * d0 + d0 * d1 + d1 * d1))


def _remaining(
    cylinders: Cylinders,
    keep: NDArray[np.bool_],
    has_predecessor: NDArray[np.bool_],
    merged_into: Ints,
) -> Cylinders:
    """Take the cylinders that are kept, and number them again."""
    kept = np.flatnonzero(keep)
    number = np.full(len(keep), -1, dtype=np.int64)
    number[kept] = np.arange(len(kept))
    parent = [
        -1 if above < 0 else int(number[_final(merged_into, above)])
        for above in cylinders.parent[kept].tolist()
    ]
    return replace(
        cylinders,
        start=cylinders.start[kept],
        end=cylinders.end[kept],
        diameter=cylinders.diameter[kept],
        parent=np.array(parent, dtype=np.int64),
        continues=None if cylinders.continues is None else has_predecessor[kept],
        labels=[cylinders.labels[index] for index in kept],
    )


def _final(merged_into: Ints, index: int) -> int:
    """Return the cylinder that one was merged into at last, and shorten the way there."""
    last = index
    while merged_into[last] != last:
        last = int(merged_into[last])
    while merged_into[index] != last:
        merged_into[index], index = last, int(merged_into[index])
    return last
