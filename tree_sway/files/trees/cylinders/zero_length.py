# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Leave out cylinders of zero length, which have no direction; scans have some."""

from __future__ import annotations

from dataclasses import replace
from itertools import compress

import numpy as np

from tree_sway.files.trees.cylinders.cylinders import Cylinders

_SHORTEST = 1e-6
"""Shorter cylinders are left out [m]."""


def without_zero_length(cylinders: Cylinders) -> Cylinders:
    """
    Return the cylinders of one tree that have a length; a note tells how many have none.

    Children of these go to their parent, and a branch continues through one that is left out;
    where that is the root, its thickest child replaces it.
    """
    keep = np.linalg.norm(cylinders.end - cylinders.start, axis=1) >= _SHORTEST
    if keep.all() or not keep.any():
        return cylinders
    parent = cylinders.parent.copy()
    continues = None if cylinders.continues is None else cylinders.continues.copy()
    # Parents of those left out are taken in their place, from round to round higher up.
    while (below := (parent >= 0) & ~keep[parent]).any():
        above = parent[below]
        parent[below] = parent[above]
        if continues is not None:
            continues[below] &= continues[above]
    roots = np.flatnonzero(keep & (parent < 0))
    first = roots[np.argmax(cylinders.diameter[roots, 0])]
    parent[roots[roots != first]] = first
    above = parent[keep]
    left_out = f'{np.count_nonzero(~keep)} cylinders of zero length were left out'
    return replace(
        cylinders,
        start=cylinders.start[keep],
        end=cylinders.end[keep],
        diameter=cylinders.diameter[keep],
        parent=np.where(above < 0, -1, np.cumsum(keep)[above] - 1),
        continues=None if continues is None else continues[keep],
        labels=[*compress(cylinders.labels, keep)],
        notes=(*cylinders.notes, left_out),
    )
