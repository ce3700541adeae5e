# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
TreeQSM's cylinder models (Raumonen et al. 2013; manual of 2.4), as MATLAB files and as text.

A row has radius, length, start (3), axis (3), parent and extension; what follows depends on the
version. Cylinders are numbered from 1, parent 0 at the root; PyTLidar writes the same columns
numbered from 0, parent -1 at the root. A cylinder that is the extension of its parent continues
the branch; any other starts one, on its parent's axis or skin and not at its end.

MATLAB: structs with a field ``cylinder``, or the variables ``Rad``, ``Len``, ``Sta``, ``Axe``,
``CPar`` and ``CExt`` of version 2.0. A file may have several models, as variables or as an
array of structs; each is a tree. A file without structs may have the columns as one array of 9 to
15, such as the ``CylData`` of versions before 2.3 and ``CylData_updated`` of published scans; with
9 columns there is no extension. Text: the same columns without a header, or with that of 2.4 and
PyTLidar, which names start and axis once, though each has three columns; tabs, spaces, commas or
semicolons between the cells.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
import re
from typing import Any

import numpy as np

from tree_sway.core.arrays import Floats, Ints
from tree_sway.errors import FormatError, inside
from tree_sway.files.file_format import contains, FileFormat
from tree_sway.files.table_file import filled_lines, parse_columns
from tree_sway.files.text_file import finite, read_lines
from tree_sway.files.trees.cylinders.cylinders import Cylinders, Trees
from tree_sway.files.trees.cylinders.mat_file import numbers, read_mat, Variables
from tree_sway.files.trees.tree_options import FITTED

_FIELDS = {'radius': 1, 'length': 1, 'start': 3, 'axis': 3, 'parent': 1, 'extension': 1}
"""Fields of ``cylinder`` in the order of the columns, and their widths."""
_VARIABLES = 'Rad Len Sta Axe CPar CExt'.split()
"""Variables of version 2.0, in the order of the fields of later ones."""
_COLUMNS = 'radius length start_x start_y start_z axis_x axis_y axis_z parent extension'.split()
_LEAST_COLUMNS, _MOST_COLUMNS = 9, 15
"""Numbers of columns of an array of cylinders."""
_CRYPTIC = 2
"""Letters of names of columns that say nothing."""
_UNMISTAKABLE = 13
"""Number of columns from which a table without a header is one of cylinders."""
_UNIT_ERROR = 0.02
"""Largest difference of the length of a cylinder's axis from 1 where it tells what a table is."""
_LARGEST_WHOLE = 2**53
"""Largest number up to which all whole numbers are floats."""
_LEAST_SHARE = 0.7
"""
Share of the rows of a table that must be cylinders: published scans whose neighbouring cylinders
were averaged have axes of any length in an eighth of them (Jackson et al. 2019).
"""


def _is_text(head: str) -> bool:
    """Whether a file is a TreeQSM text, by its header, or by the width of its first rows."""
    lines = filled_lines(head.splitlines())[1][:2]
    if not lines:
        return False
    if lines[0].lower().startswith('radius') and 'axis_direction' in lines[0]:
        return True
    numbers = [list(map(finite, _cells(line))) for line in lines]
    names = list(map(_letters, _cells(lines[0])))
    places = {_letters(name): place for place, name in enumerate(_COLUMNS)}
    is_named = {*numbers[0]} == {None}
    if is_named and max(map(len, names)) > _CRYPTIC and not places.keys() & set(names):
        return False  # a header of other columns
    if any(places.get(name, place) != place for place, name in enumerate(names)):
        return False  # a header that names them elsewhere
    rows = [row for row in numbers if None not in row and len(row) >= _LEAST_COLUMNS]
    is_wide = any(len(row) >= _UNMISTAKABLE for row in rows)
    return is_wide or (bool(rows) and all(_are_cylinders(np.array([row])) for row in rows))


def _letters(name: str) -> str:
    return re.sub('[^a-z]', '', name.lower())


def _are_cylinders(table: Floats) -> bool:
    """Whether the columns of an array, (n, 9 to 15), are those of cylinders."""
    axis_length = np.linalg.norm(table[:, 5:8], axis=1)
    parent = table[:, 8]
    is_unit = np.abs(axis_length - 1.0) < _UNIT_ERROR
    is_point = (axis_length == 0.0) & (table[:, 1] == 0.0)
    has_size = (table[:, :2] >= 0.0).all(axis=1)
    has_parent = (parent == np.round(parent)) & (parent >= -1)
    are_cylinders = (is_unit | is_point) & has_size & has_parent
    return bool(are_cylinders.mean() > _LEAST_SHARE)


def _read_mat(path: Path) -> Trees:
    """Every cylinder model of a MATLAB file."""
    variables = read_mat(path)
    tables = [(name, _table(name, model)) for name, model in _models(variables)]
    tables = tables or list(_arrays(variables))
    if not tables:
        raise FormatError(
            "no struct with a field 'cylinder', and no array of cylinders",
            cure='save the QSM struct of TreeQSM, or its columns as an array of 9 to 15',
        )
    return tuple(
        _cylinders(table, [f'{name} cylinder {i + 1}' for i in range(len(table))], name)
        for name, table in tables
    )


def read_treeqsm_text(path: Path) -> Trees:
    """Read the cylinders of a TreeQSM text."""
    lines = read_lines(path)
    titles = [row for row, line in enumerate(lines) if line.startswith('#')][1:]
    lines = lines[: titles[0]] if titles else lines  # tables of branches and of the tree follow
    table = parse_columns(lines, str(path), _COLUMNS, _cells)
    if table.texts and all(finite(cell) is None for cell in _cells(table.texts[0])):
        table = table.part(table.rows[1:])
    has_extension = any(len(_cells(text)) != _LEAST_COLUMNS for text in table.texts[:1])
    names = _COLUMNS if has_extension else _COLUMNS[:-1]
    values = table.strict(names)
    labels = [f'{table.where(row)}: cylinder {row + 1}' for row in range(len(values))]
    return (_cylinders(values, labels),)


def _cells(line: str) -> list[str]:
    """Cells of a row; commas separate only where neither semicolons nor white space do."""
    cells = line.replace(';', ' ').split()
    return cells if len(cells) >= _LEAST_COLUMNS else line.replace(',', ' ').split()


def _models(variables: Variables) -> Iterator[tuple[str, Variables]]:
    """Name and columns of each cylinder model, by field name."""
    if variables.keys() >= {*_VARIABLES}:
        yield 'tree', dict(zip(_FIELDS, map(variables.get, _VARIABLES), strict=True))
    for name, value in variables.items():
        structs = _structs(value)
        for number, struct in enumerate(structs, start=1):
            own_name = f'{name}{number}' if len(structs) > 1 else name
            for model in _structs(struct.get('cylinder', struct))[:1]:
                if 'radius' in model:
                    yield own_name, model


def _arrays(variables: Variables) -> Iterator[tuple[str, Floats]]:
    """Name and columns of each array of cylinders, those of cells as well."""
    for name, value in variables.items():
        if isinstance(value, dict):
            inside = {f'{name}{number}': each for number, each in enumerate(value.values(), 1)}
            yield from _arrays(inside)
        elif isinstance(value, np.ndarray) and value.ndim == 2:
            whole = value.astype(np.float64)
            for table in (whole, whole.T):
                has_width = _LEAST_COLUMNS <= table.shape[1] <= _MOST_COLUMNS
                if len(table) and has_width and _are_cylinders(table):
                    yield name, table[:, : len(_COLUMNS)]
                    break


def _structs(value: Any) -> list[Variables]:
    """Return the structs of an array of them, whose names are numbers, or a struct alone."""
    if not isinstance(value, dict):
        return []
    if all(map(str.isdigit, value)):
        return [each for each in value.values() if isinstance(each, dict)]
    return [value]


def _table(name: str, fields: Variables) -> Floats:
    """Columns of the table of cylinders from fields of their names."""
    columns = []
    for field, width in _FIELDS.items():
        if field == 'extension' and field not in fields:
            continue  # continuations are found by the diameters, as without its column
        if field not in fields:
            raise FormatError(
                f"{name} has no numbers '{field}'", cure='save the QSM struct of TreeQSM'
            )
        with inside(name):
            column = numbers(fields[field], field)
        if column.size % width:
            raise FormatError(f'{name}.{field} has {column.size} values')
        columns.append(column.reshape(-1, width))
    if len({len(column) for column in columns}) > 1:
        raise FormatError('columns of different lengths', cure='export it again')
    return np.hstack(columns)


def _cylinders(table: Floats, labels: list[str], name: str = '') -> Cylinders:
    """Cylinders from the columns, (n, 9 or 10), with the name of each row in errors."""
    if len(table) == 0:
        raise FormatError('no cylinders')
    diameter = 2.0 * table[:, [0, 0]]
    length, start, axis = table[:, 1], table[:, 2:5], table[:, 5:8]
    parent, *extension = _indices(table[:, 8:10], labels)
    axis_length = np.linalg.norm(axis, axis=1)
    for row in np.flatnonzero((axis_length == 0.0) & (length > 0.0))[:1]:
        raise FormatError('an axis without direction', where=labels[row])
    axis_length[axis_length == 0.0] = 1.0  # of cylinders without length
    end = start + (length / axis_length)[:, None] * axis
    continues = None
    for each in extension:
        after = each.take(parent, mode='clip')
        continues = (parent >= 0) & (after == np.arange(len(parent)))
    return Cylinders(start, end, diameter, parent, continues, labels, name)


def _indices(numbers: Floats, labels: list[str]) -> Ints:
    """Rows of parents and extensions, (1 or 2, n), from their numbers, (n, 1 or 2)."""
    is_whole = (numbers == np.round(numbers)) & (np.abs(numbers) <= _LARGEST_WHOLE)
    for row, column in np.argwhere(~is_whole)[:1]:
        raise FormatError(
            f'parent or extension is {numbers[row, column]:g}, not a whole number',
            where=labels[row],
        )
    root = int(numbers[:, 0].min())
    if root not in (-1, 0):
        raise FormatError(f'the smallest parent is {root}', cure='the root has parent 0, or -1')
    return numbers.T.astype(np.int64) - (root + 1)


MAT = FileFormat('treeqsm-mat', ('.mat',), contains(r'\AMATLAB'), _read_mat, FITTED)
TEXT = FileFormat('treeqsm-text', ('.cyl',), _is_text, read_treeqsm_text, FITTED)
