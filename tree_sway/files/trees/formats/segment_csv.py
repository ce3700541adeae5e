# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A plain table of segments: one row each, with nodes, diameters, parent and branch.

Columns ``segment, parent, branch, x0, y0, z0, x1, y1, z1, d0, d1`` in any order, in metres;
``segment`` names the row and ``parent`` refers to such a name, -1 for the root; without ``branch``
the branches are found from continuations of segments, without ``d1`` a segment is a cylinder.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from tree_sway.core.species import species_named
from tree_sway.files.file_format import FileFormat, has_columns
from tree_sway.files.table_file import parse_table
from tree_sway.files.text_file import read_lines
from tree_sway.files.trees.assembly import built_tree
from tree_sway.files.trees.imported_tree import TreeFile


def _read(path: Path) -> TreeFile:
    """Tree from a table of segments."""
    text = parse_table(read_lines(path), str(path))
    columns = {column.lower() for column in text.columns}
    labels, parents = text.family('segment', 'parent', [-1], 'segment')
    tip = 'd1' if 'd1' in columns else 'd0'
    values = text.strict(['x0', 'y0', 'z0', 'x1', 'y1', 'z1', 'd0', tip])
    branch = None
    if 'branch' in columns:
        branch = text.whole(text.strict(['branch'])[:, 0], 'branch')
    wood = species_named('broadleaf')
    tree = built_tree(
        str(path), *np.hsplit(values, [3, 6]), parent=parents, branch=branch, labels=labels,
        name=path.stem, species=wood.key,
    )  # fmt: skip
    return TreeFile(tree, wood, str(path))


FORMAT = FileFormat('csv', (), has_columns('x0', 'y0', 'z0', 'x1', 'd0'), _read)
