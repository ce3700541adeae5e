# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Cylinders of a scanned or digitised tree to a tree.

The module of a format only parses; the rest is shared: branches without a parent are joined to the
nearest cylinder, cylinders of zero length are left out, and chains of extensions become branches.
Each step reports its changes in a note.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from tree_sway.core.species import species_named
from tree_sway.core.tree import check_numbers, checked_order, tree_from_segments
from tree_sway.errors import FormatError
from tree_sway.files.trees.cylinders.coarse_positions import coarse_positions
from tree_sway.files.trees.cylinders.cylinders import Cylinders
from tree_sway.files.trees.cylinders.joining import branch_keys, with_joined_branches
from tree_sway.files.trees.cylinders.zero_length import without_zero_length
from tree_sway.files.trees.imported_tree import TreeFile


def tree_of_cylinders(cylinders: Cylinders, path: Path) -> TreeFile:
    """
    Build a tree from cylinders.

    Raises a `TreeError` for an impossible one: no root, a cycle, several trees, values that are
    not finite.
    """
    species = species_named('broadleaf')
    if len(cylinders.start) == 0:
        raise FormatError('no cylinders')
    numbers = np.hstack([cylinders.start, cylinders.end, cylinders.diameter])
    check_numbers(numbers, cylinders.labels)
    faults = coarse_positions(cylinders.start)
    checked_order(cylinders.parent, cylinders.labels)  # no cycles from here on
    cylinders = without_zero_length(with_joined_branches(cylinders))
    tree = tree_from_segments(
        cylinders.start, cylinders.end, cylinders.diameter, parent=cylinders.parent,
        branch=branch_keys(cylinders), labels=cylinders.labels, name=cylinders.name or path.stem,
        species=species.key,
    )  # fmt: skip
    return TreeFile(tree, species, str(path), cylinders.notes, faults)
