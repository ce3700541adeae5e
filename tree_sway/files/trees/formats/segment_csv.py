# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A plain table of segments: one row each, with nodes, diameters, parent and branch.

Columns ``segment, parent, branch, x0, y0, z0, x1, y1, z1, d0, d1`` in any order, in metres;
``segment`` names the row and ``parent`` refers to such a name, -1 for the root; without ``branch``
the branches are found from continuations of segments, without ``d1`` a segment is a cylinder.

Cylinders without parents, ``x1, y1, z1, x2, y2, z2, radius`` in metres, are joined where one
begins at the end of another.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from tree_sway.core.species import species_named
from tree_sway.core.tree import tree_from_segments
from tree_sway.files.file_format import FileFormat, has_columns
from tree_sway.files.table_file import parse_table
from tree_sway.files.text_file import read_lines
from tree_sway.files.trees.imported_tree import TreeFile


def _read(path: Path) -> TreeFile:
    """Tree from a table of segments, or of both ends and the radius of cylinders."""
    text = parse_table(read_lines(path), str(path))
    columns = {column.lower() for column in text.columns}
    wood = species_named('broadleaf')
    order: dict[str, Any] = {}
    notes: tuple[str, ...] = ()
    if {*_ENDS, 'radius'} <= columns:
        notes = ('parents are found by the ends that meet',)
        values = text.strict([*_ENDS, 'radius', 'radius'])
        values[:, 6:] *= 2.0
    else:
        order['labels'], order['parent'] = text.family('segment', 'parent', [-1], 'segment')
        tip = 'd1' if 'd1' in columns else 'd0'
        values = text.strict(['x0', 'y0', 'z0', 'x1', 'y1', 'z1', 'd0', tip])
        if 'branch' in columns:
            order['branch'] = text.whole(text.strict(['branch'])[:, 0], 'branch')
    parts = np.hsplit(values, [3, 6])
    tree = tree_from_segments(*parts, **order, name=path.stem, species=wood.key)
    return TreeFile(tree, wood, str(path), notes)


_ENDS = ('x1', 'y1', 'z1', 'x2', 'y2', 'z2')
_HAS_ENDS = has_columns(*_ENDS, 'radius')
_HAS_SEGMENTS = has_columns('x0', 'y0', 'z0', 'x1', 'd0')
FORMAT = FileFormat('csv', (), lambda head: _HAS_SEGMENTS(head) or _HAS_ENDS(head), _read)
