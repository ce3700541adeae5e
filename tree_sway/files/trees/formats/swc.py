# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
SWC, the skeleton format of neuroscience, which tree reconstructions use too.

A node in each line: number, type, x, y, z, radius, parent, -1 at a root; spaces or commas are
between, further columns and a line of names are passed over. Each root is a separate
tree. SWC has no unit: see ``length_unit`` and ``diameter_unit`` of `TreeOptions`.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
import re

import numpy as np

from tree_sway.core.tree import checked_order
from tree_sway.errors import FormatError
from tree_sway.files.file_format import FileFormat
from tree_sway.files.table_file import filled_lines, parse_columns
from tree_sway.files.text_file import finite, read_lines
from tree_sway.files.trees.cylinders.cylinders import Trees
from tree_sway.files.trees.cylinders.joining import roots_of
from tree_sway.files.trees.cylinders.skeleton import cylinders_of_nodes

_COLUMNS = 'number type x y z radius parent'.split()
_NAMES = re.compile(r'\s*[a-z]+[\s,;]+type\b.*\bradius\b', re.IGNORECASE)
_TYPES = 256.0
"""Types of nodes are below; what has a year there is no skeleton."""
_BETWEEN = re.compile(r'[\s,;]+')


def _is_swc(head: str) -> bool:
    """Whether the beginning of a file is that of an SWC file."""
    _, lines = filled_lines(_without_names(head.splitlines()))
    cells = _cells(lines[0]) if lines else []
    numbers = [each for each in map(finite, cells[:7]) if each is not None]
    is_root = len(cells) == 7 or cells[6:7] == ['-1']
    return is_root and len(numbers) == 7 and 0.0 <= numbers[1] < _TYPES and numbers[6] % 1.0 == 0.0


def _without_names(lines: Sequence[str]) -> list[str]:
    return ['' if _NAMES.match(line) else line for line in lines]


def _cells(line: str) -> list[str]:
    return _BETWEEN.split(line.strip())


def _read(path: Path) -> Trees:
    """Trees of an SWC file."""
    table = parse_columns(_without_names(read_lines(path)), str(path), _COLUMNS, _cells)
    if not table.texts:
        raise FormatError('no nodes', cure='give a node in each line')
    nodes = table.strict(_COLUMNS)[:, 2:6]
    labels, parent = table.family('number', 'parent', [-1], 'node')
    order = checked_order(parent, labels)
    root = roots_of(parent)[order]
    return tuple(
        cylinders_of_nodes(
            order[root == each], nodes[:, :3], 2.0 * nodes[:, 3], parent, labels, cones=True
        )
        for each in np.flatnonzero(parent < 0)
    )


FORMAT = FileFormat('swc', ('.swc',), _is_swc, _read)
