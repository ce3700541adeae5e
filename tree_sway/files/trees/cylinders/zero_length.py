# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Leave out cylinders of zero length, which have no direction; scans have some."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tree_sway.core.arrays import Ints
from tree_sway.files.trees.cylinders.cylinders import Cylinders

_SHORTEST = 1e-6
"""Shorter cylinders are left out [m]."""


def without_zero_length(cylinders: Cylinders, order: Ints) -> Cylinders:
    """
    Return the cylinders of one tree that have a length; a note tells how many have none.

    Children of these go to their parent, and a branch continues through one that is left out;
    where that is the root, its thickest child replaces it. The order has parents first.
    """
    keep = np.linalg.norm(cylinders.end - cylinders.start, axis=1) >= _SHORTEST
    if keep.all() or not keep.any():
        return cylinders
    parent = cylinders.parent.copy()
    continues = None if cylinders.continues is None else cylinders.continues.copy()
    for index in order.tolist():
        above = parent[index]
        if above >= 0 and not keep[above]:
            parent[index] = parent[above]  # which stays, as it came before
            if continues is not None:
                continues[index] &= continues[above]
    roots = np.flatnonzero(keep & (parent < 0))
    first = roots[np.argmax(cylinders.diameter[roots, 0])]
    parent[roots[roots != first]] = first
    number = np.cumsum(keep) - 1
    rows = np.flatnonzero(keep)
    above = parent[rows]
    left_out = f'{np.count_nonzero(~keep)} cylinders of zero length were left out'
    return replace(
        cylinders,
        start=cylinders.start[rows],
        end=cylinders.end[rows],
        diameter=cylinders.diameter[rows],
        parent=np.where(above < 0, -1, number[above]),
        continues=None if continues is None else continues[rows],
        labels=[cylinders.labels[index] for index in rows],
        notes=(*cylinders.notes, left_out),
    )
