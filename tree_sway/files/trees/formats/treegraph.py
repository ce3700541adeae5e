# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Cylinders of treegraph (Yang et al.), as JSON, or ``cyls`` alone as a table; other JSON is named.

JSON has a text of each table, ``cyls`` a value of each cylinder by column and row: it begins at
node ``p1``, at ``sx, sy, sz``, and goes ``length`` along ``ax, ay, az`` to node ``p2``.
"""

from __future__ import annotations

from pathlib import Path
import re

import numpy as np

from tree_sway.errors import FormatError, inside
from tree_sway.files.cell_table import table_of_cells
from tree_sway.files.file_format import FileFormat, has_columns
from tree_sway.files.json_values import cell_of, object_of, parsed
from tree_sway.files.table_file import parse_table, TextTable
from tree_sway.files.text_file import read_lines, read_text
from tree_sway.files.trees.cylinders.cylinders import Trees
from tree_sway.files.trees.cylinders.rooted import cylinders_of_edges
from tree_sway.files.trees.tree_options import FITTED

_OURS = re.compile(r'"(tree_sway|branches|segments)"\s*:')
_COLUMNS = ('p1', 'p2', 'sx', 'sy', 'sz', 'ax', 'ay', 'az', 'length', 'radius')


def _is_other_json(head: str) -> bool:
    """Whether the beginning of a file is JSON without a key of our own form."""
    return head.lstrip()[:1] in ('{', '[') and '"' in head and _OURS.search(head) is None


def _read(path: Path) -> Trees:
    """Cylinders of a file of treegraph."""
    document = parsed(read_text(path))
    if not isinstance(document, dict) or 'cyls' not in document:
        has = f'keys {", ".join(map(repr, [*document][:8]))}'
        said = has if isinstance(document, dict) else 'a list'
        raise FormatError(
            f'JSON of {said}, which is no tree',
            cure="give a tree with 'branches' (doc/trees.md), or the file of treegraph with "
            "'cyls'",
        )
    table = document['cyls']
    with inside('cyls'):
        table = parsed(table) if isinstance(table, str) else table
    columns = {name: each for name, each in object_of(table).items() if object_of(each)}
    numbers = object_of(columns.get('p1'))
    rows = [[cell_of(each.get(row)) for each in columns.values()] for row in numbers]
    return _joined(table_of_cells([*columns], rows, str(path)))


def _read_table(path: Path) -> Trees:
    """Cylinders of ``cyls`` as a table."""
    return _joined(parse_table(read_lines(path), str(path)))


def _joined(table: TextTable) -> Trees:
    """Cylinders of the rows."""
    values = table.values(map(table.index_of, _COLUMNS))
    is_point = values[:, 8] == 0.0
    values[is_point, 5:8] = 0.0  # a cylinder without length has no direction
    for row, column in np.argwhere(~np.isfinite(values))[:1]:
        raise FormatError(
            f"no number in '{_COLUMNS[column]}'", where=f'cylinder {row}', cure='fit it again'
        )
    nodes, edges = np.unique(values[:, :2], return_inverse=True)
    edges = edges.reshape(-1, 2)
    point = np.empty((len(nodes), 3))
    point[edges[:, 1]] = values[:, 2:5] + values[:, 8:9] * values[:, 5:8]
    point[edges[:, 0]] = values[:, 2:5]
    made = cylinders_of_edges(point, edges, values[:, 9], of_nodes=False)
    return (made,)


FORMAT = FileFormat('treegraph', (), _is_other_json, _read, FITTED)
TABLE = FileFormat('treegraph-table', (), has_columns(*_COLUMNS), _read_table, FITTED)
