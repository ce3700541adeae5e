# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Tables of cylinders with both ends and a radius: aRchi's and SimpleForest's.

aRchi (Martin-Ducup et al. 2021) numbers from 1, the root's parent 0; a cylinder that is the
``extension_ID`` of its parent continues the branch. SimpleForest (Hackenberg et al. 2021) numbers
from 0, the root's parent -1, and has no column for the extension. The branch order replaces it: of
the children of a cylinder the one of the same order continues; ``branchID`` numbers whole limbs
with their subtrees, not chains. Of several of the same order, the one with the greatest growth
length, that of its subtree, continues; without that column, the thickest.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from tree_sway.core.tree import first_of_each
from tree_sway.files.file_format import FileFormat, has_columns
from tree_sway.files.table_file import parse_table
from tree_sway.files.text_file import read_lines
from tree_sway.files.trees.cylinders.cylinders import cylinder_axes, Cylinders
from tree_sway.files.trees.tree_options import FITTED


def _read_archi(path: Path) -> tuple[Cylinders, ...]:
    """Cylinders of an aRchi table."""
    table = parse_table(read_lines(path), str(path))
    labels, parent = table.family('cyl_ID', 'parent_ID', [0, -1], 'cylinder')
    number, after = table.strict(['cyl_ID', 'extension_ID']).T
    extension = table.whole(after, 'extension_ID')
    continues = (parent >= 0) & (extension[parent] == number)
    return (Cylinders(*cylinder_axes(table, 'radius_cyl'), parent, continues, labels),)


def _read_simpleforest(path: Path) -> tuple[Cylinders, ...]:
    """Cylinders of a SimpleForest table."""
    table = parse_table(read_lines(path), str(path))
    labels, parent = table.family('ID', 'parentID', [-1], 'cylinder')
    columns = {column.lower() for column in table.columns}
    size = 'growthLength' if 'growthlength' in columns else 'radius'
    order, growth = table.strict(['branchOrder', size]).T
    rivals = np.flatnonzero((parent >= 0) & (order == order[parent]))
    continuations = first_of_each(parent, rivals, -growth[rivals], rivals)
    continues = np.isin(np.arange(len(parent)), continuations)
    return (Cylinders(*cylinder_axes(table, 'radius'), parent, continues, labels),)


ARCHI = FileFormat('archi', (), has_columns('cyl_ID', 'extension_ID'), _read_archi, FITTED)
SIMPLEFOREST = FileFormat(
    'simpleforest',
    (),
    has_columns('ID', 'parentID', 'startX', 'branchOrder'),
    _read_simpleforest,
    FITTED,
)
