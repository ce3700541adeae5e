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
"""

from __future__ import annotations

from pathlib import Path
import re

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.tree import first_of_each
from tree_sway.files.cell_table import table_of_cells
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
    first = table.strict(['ID'])[:, 0].min(initial=1.0)
    labels, parent = table.family('ID', 'parentID', [-1, 0] if first else [-1], 'cylinder')
    columns = {column.lower() for column in table.columns}
    size = 'growthLength' if 'growthlength' in columns else 'radius'
    order, growth = table.strict(['branchOrder', size]).T
    rivals = np.flatnonzero((parent >= 0) & (order == order[parent]))
    continuations = first_of_each(parent, rivals, -growth[rivals], rivals)
    continues = np.isin(np.arange(len(parent)), continuations)
    return (Cylinders(*cylinder_axes(table, 'radius'), parent, continues, labels),)


def _names(line: str) -> dict[str, str]:
    """Names of columns by their letters and digits alone."""
    return {re.sub(r'[\W_]', '', cell).lower(): cell for cell in re.split('[,;\t]', line)}


def _is_named(head: str) -> bool:
    """Whether the first line names a start, an axis or an end, a radius and a parent."""
    lines = (line for line in head.splitlines() if line.strip() and not line.startswith('#'))
    names = _names(next(lines, ''))
    ends = any({f'{end}{axis}' for axis in 'xyz'} <= names.keys() for end in ('end', 'axis'))
    return ends and {'startx', 'starty', 'startz', 'radius', 'parent'} <= names.keys()


def _read_named(path: Path) -> tuple[Cylinders, ...]:
    """Cylinders of a table that names its columns as rTwig does."""
    table = parse_table(read_lines(path), str(path))
    names = {own: each for column in table.columns for own, each in _names(column).items()}

    def columns(word: str) -> Floats:
        return table.strict([names.get(f'{word}{axis}', word) for axis in 'xyz'])

    start, radius = columns('start'), table.strict([names['radius']])[:, 0]
    if 'endx' in names:
        end = columns('end')
    else:
        end = start + table.strict([names.get('length', 'length')]) * columns('axis')
    if 'id' not in names:
        rows = [[*table.split(text), str(row)] for row, text in enumerate(table.texts, start=1)]
        table = table_of_cells([*table.columns, 'id'], rows, str(path), table.numbers)
    labels, parent = table.family(names.get('id', 'id'), names['parent'], [0, -1], 'cylinder')
    continues = None
    if 'branch' in names:
        branch = table.strict([names['branch']])[:, 0]
        continues = (parent >= 0) & (branch == branch[parent])
    diameter = np.stack([2.0 * radius, 2.0 * radius], axis=1)
    return (Cylinders(start, end, diameter, parent, continues, labels),)


ARCHI = FileFormat('archi', (), has_columns('cyl_ID', 'extension_ID'), _read_archi, FITTED)
SIMPLEFOREST = FileFormat(
    'simpleforest',
    (),
    has_columns('ID', 'parentID', 'startX', 'branchOrder'),
    _read_simpleforest,
    FITTED,
)
NAMED = FileFormat('rtwig', (), _is_named, _read_named, FITTED)
