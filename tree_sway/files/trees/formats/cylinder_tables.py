# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Tables of cylinders with a header: aRchi's, SimpleForest's, treegraph's and rTwig's.

aRchi (Martin-Ducup et al. 2021) numbers from 1, the root's parent 0; a cylinder that is the
``extension_ID`` of its parent continues the branch. SimpleForest (Hackenberg et al. 2021) numbers
from 0, the root's parent -1, and has no column for the extension. The branch order replaces it: of
the children of a cylinder the one of the same order continues; ``branchID`` numbers whole limbs
with their subtrees, not chains. Of several of the same order, the one with the greatest growth
length, that of its subtree, continues; without that column, the thickest.

rTwig writes the models of other programs under names of its own, ``start.x`` or ``start_x``, and
numbers from 1, the root's parent 0. Without an ``id`` the number is that of the row.

Names are compared by their letters and digits alone; SimpleTree (Hackenberg et al. 2015) has
``SegmentID`` for the ``ID``.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.tree import first_of_each
from tree_sway.files.column_names import folded
from tree_sway.files.file_format import FileFormat, has_columns
from tree_sway.files.table_file import parse_table
from tree_sway.files.text_file import read_lines
from tree_sway.files.trees.cylinders.cylinders import Cylinders, Trees
from tree_sway.files.trees.tree_options import FITTED


def _read(path: Path) -> Trees:
    """Cylinders of a table."""
    table = parse_table(read_lines(path), str(path))
    names = {folded(column): column for column in table.columns}
    names = {name.replace('segment', ''): names[name] for name in names} | names

    def columns(word: str) -> Floats:
        return table.strict([names.get(f'{word}{axis}', word) for axis in 'xyz'])

    def column(*words: str) -> Floats:
        found = (names[word] for word in words if word in names)
        return table.strict([next(found, words[0])])[:, 0]

    start = columns('start')
    radius = column('radius', 'radiuscyl')
    if 'endx' in names:
        end = columns('end')
    else:
        end = start + column('length')[:, None] * columns('axis')
    number = names.get('cylid', names.get('id', ''))
    roots = [-1, 0] if number and not table.strict([number]).min(initial=1.0) else [0, -1]
    missing = 'parent_ID' if 'cylid' in names else 'parentID'
    above = names.get('parent', names.get('parentid', missing))
    labels, parent = table.family(number, above, roots, 'cylinder')
    has_parent = parent >= 0
    continues = None
    if 'branch' in names:
        branch = column('branch')
        continues = has_parent & (branch == branch[parent])
    elif 'extensionid' in names:
        own = table.strict([number])[:, 0]
        after = table.whole(column('extensionid'), names['extensionid'])
        continues = has_parent & (after[parent] == own)
    elif 'branchorder' in names:
        order = column('branchorder')
        size = column('growthlength', 'radius')
        rivals = np.flatnonzero(has_parent & (order == order[parent]))
        largest = first_of_each(parent, rivals, -size[rivals], rivals)
        continues = np.isin(np.arange(len(parent)), largest)
    diameter = 2.0 * np.column_stack([radius, radius])
    return (Cylinders(start, end, diameter, parent, continues, labels),)


ARCHI = FileFormat('archi', (), has_columns('cyl_ID', 'extension_ID'), _read, FITTED)
_OF_FOREST = has_columns('ID', 'parentID', 'startX', 'branchOrder')
SIMPLEFOREST = FileFormat('simpleforest', (), _OF_FOREST, _read, FITTED)
_OF_SEGMENTS = has_columns('segmentID', 'parentSegmentID', 'startX', 'startY', 'startZ', 'radius')
_OF_TWIG = has_columns('startX', 'startY', 'startZ', 'radius', 'parent')
_HAS_END, _HAS_AXIS = has_columns('endX', 'endY', 'endZ'), has_columns('axisX', 'axisY', 'axisZ')
NAMED = FileFormat(
    'rtwig',
    (),
    lambda head: (_OF_TWIG(head) or _OF_SEGMENTS(head)) and (_HAS_END(head) or _HAS_AXIS(head)),
    _read,
    FITTED,
)
