# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
RayCloudTools' tree file (Lowe & Stepanas 2021): a tree in each line, node after node.

After comments a header, such as ``height,crown_radius, x,y,z,radius,parent_id,section_id``:
attributes of the tree, if any, then the fields of a node. The first node of a line is the root,
parent -1, and has no volume; each of the others is a cylinder from its parent's point to its own,
with its own radius.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from tree_sway.errors import FormatError, TreeError
from tree_sway.files.file_format import contains, FileFormat
from tree_sway.files.table_file import filled_lines, split_row, TextTable
from tree_sway.files.text_file import read_lines
from tree_sway.files.trees.cylinders.cylinders import Cylinders, Trees
from tree_sway.files.trees.cylinders.skeleton import cylinders_of_nodes
from tree_sway.files.trees.tree_options import FITTED

_FIELDS = 'x y z radius parent_id'.split()


def _read(path: Path) -> Trees:
    """Trees of a file."""
    numbers, lines = filled_lines(read_lines(path))
    if not lines:
        raise FormatError('no header', cure=f'a header names {",".join(_FIELDS)}')
    of_tree, found, of_node = lines[0].partition('x,y,z,radius')
    columns = _cells(found + of_node)
    for name in _FIELDS:
        if name not in columns:
            trunks = ': trunks without branches' if name == 'parent_id' else ''
            raise FormatError(
                f'no field {name}{trunks}',
                where=f'{path}:{numbers[0]}',
                cure='extract the trees with rayextract trees',
            )
    if len(lines) < 2:
        raise FormatError('no trees')
    begin = len(_cells(of_tree))
    return tuple(
        _tree(_cells(line)[begin:], columns, f'{path}:{number}')
        for number, line in zip(numbers[1:], lines[1:], strict=True)
    )


def _cells(line: str) -> list[str]:
    """Cells of a line that are not empty."""
    return [cell for cell in split_row(line, ',') if cell]


def _tree(cells: list[str], columns: list[str], where: str) -> Cylinders:
    """Cylinders of a line, whose nodes are the rows of a table."""
    size = len(columns)
    if not cells or len(cells) % size:
        raise FormatError(
            f'{len(cells)} values are not whole nodes of {size}',
            where=where,
            cure=f'a node has {",".join(columns)}',
        )
    nodes = [cells[begin : begin + size] for begin in range(0, len(cells), size)]
    table = TextTable(tuple(columns), range(len(nodes)), nodes, list, f'{where}: node')
    values = table.strict(_FIELDS)
    parent = table.whole(values[:, 4], 'parent_id')
    labels = [f'{where}: node {row}' for row in table.rows]
    for row, above in enumerate(parent.tolist()):
        is_root = above < 0
        if is_root != (row == 0) or above >= len(nodes):
            raise TreeError(
                f'parent_id is {above}',
                where=labels[row],
                cure='the first node has -1, every other the number of a node of its line',
            )
    rows = np.arange(len(nodes))
    return cylinders_of_nodes(
        rows, values[:, :3], 2.0 * values[:, 3], np.maximum(parent, -1), labels, cones=False
    )


FORMAT = FileFormat('treefile', (), contains(r'^(?!#).*\bx,y,z,radius\b'), _read, FITTED)
