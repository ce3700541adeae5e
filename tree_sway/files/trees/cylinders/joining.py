# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Topology of cylinders: order, loose branches, and chains that are branches."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tree_sway.core.arrays import Ints
from tree_sway.core.tree import chain_starts, first_of_each
from tree_sway.errors import TreeError
from tree_sway.files.trees.cylinders.cylinders import Cylinders
from tree_sway.files.trees.nearest_axis import nearest_axis

_MAX_LOOSE = 1000
_MAX_LOOSE_VOLUME = 0.2
"""Share of the stem's volume above which a loose part is a separate tree."""


def roots_of(parents: Ints) -> Ints:
    """Return the root that each member of trees without cycles hangs on, (n,)."""
    root = np.where(parents < 0, np.arange(len(parents)), parents)
    while not np.array_equal(root[root], root):
        root = root[root]
    return root


def with_joined_branches(cylinders: Cylinders) -> Cylinders:
    """
    Join branches without a parent to the nearest cylinder of the stem, with a note.

    A `TreeError` reports a loose part so large that it is a separate tree.
    """
    roots = np.flatnonzero(cylinders.parent == -1)
    if len(roots) <= 1:
        return cylinders
    root_of = roots_of(cylinders.parent)
    length = np.linalg.norm(cylinders.end - cylinders.start, axis=1)
    volume = np.bincount(root_of, weights=length * cylinders.diameter.mean(axis=1) ** 2)
    stem = roots[np.argmax(volume[roots])]
    loose = roots[roots != stem]
    largest = loose[np.argmax(volume[loose])]
    if len(loose) > _MAX_LOOSE or volume[largest] > _MAX_LOOSE_VOLUME * volume[stem]:
        raise TreeError(
            f'{len(roots)} roots: a forest of trees that are not connected',
            where=cylinders.labels[largest],
            cure='give each tree its own file, or this cylinder a parent',
        )
    on_stem = np.flatnonzero(root_of == stem)
    axes = cylinders.start[on_stem], cylinders.end[on_stem]
    found = [nearest_axis(*axes, cylinders.start[each]) for each in loose]
    nearest, distances = zip(*found, strict=True)
    joined = cylinders.parent.copy()
    joined[loose] = on_stem[[*nearest]]
    note = (
        f'{len(loose)} branches had no parent and were joined to the nearest cylinder, at most '
        f'{max(distances):.3g} m away'
    )
    return replace(cylinders, parent=joined, notes=(*cylinders.notes, note))


def branch_keys(cylinders: Cylinders) -> Ints | None:
    """
    Branch of each cylinder, (n,); None if the file has no continuations.

    Of several children that continue a branch, the thickest is used.
    """
    if cylinders.continues is None:
        return None
    child = np.flatnonzero((cylinders.parent >= 0) & cylinders.continues)
    thickest = first_of_each(cylinders.parent, child, -cylinders.diameter[child, 0], child)
    return chain_starts(cylinders.parent, thickest)
