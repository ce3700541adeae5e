# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
TreeQSM's cylinder models (Raumonen et al. 2013; manual of 2.4), as MATLAB files and as text.

A row has radius, length, start (3), axis (3), parent and extension; what follows depends on the
version. Cylinders are numbered from 1, parent 0 at the root; PyTLidar writes the same columns
numbered from 0, parent -1 at the root. A cylinder that is the extension of its parent continues
the branch; any other starts one, on its parent's axis or skin and not at its end.

MATLAB: structs with a field ``cylinder``. A file may have several models, as variables or as an
array of structs; each is a tree. A file without structs may have the columns as one array of 9 to
15, such as the ``CylData`` of versions before 2.3 and ``CylData_updated`` of published scans; with
9 columns there is no extension. Text: the same columns without a header, or with that of 2.4 and
PyTLidar, which names start and axis once, though each has three columns; tabs, spaces, commas or
semicolons between the cells.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.errors import FormatError
from tree_sway.files.file_format import FileFormat
from tree_sway.files.table_file import parse_columns
from tree_sway.files.text_file import finite, read_lines
from tree_sway.files.trees.cylinders.cylinders import Cylinders
from tree_sway.files.trees.cylinders.mat_file import looks_like_mat, numbers, read_mat

_FIELDS = {'radius': 1, 'length': 1, 'start': 3, 'axis': 3, 'parent': 1, 'extension': 1}
"""Fields of ``cylinder`` in the order of the columns, and their widths."""
_LEAST_COLUMNS, _MOST_COLUMNS = 9, 15
"""Numbers of columns of an array of cylinders."""
_UNMISTAKABLE = 13
"""Number of columns from which a table without a header is one of cylinders."""
_UNIT_ERROR = 0.02
"""Largest difference of the length of a cylinder's axis from 1 where it tells what a table is."""
_LEAST_SHARE = 0.7
"""
Share of the rows of a table that must be cylinders: published scans whose neighbouring cylinders
were averaged have axes of any length in an eighth of them (Jackson et al. 2019).
"""


def _is_text(head: str) -> bool:
    """Whether a file is a TreeQSM text, by its header, or by the width of its first rows."""
    lines = [line for line in head.splitlines() if line.strip()][:2]
    if lines and lines[0].lower().startswith('radius') and 'axis_direction' in lines[0]:
        return True
    rows = [[finite(cell) for cell in _cells(line)] for line in lines]
    full = [[each for each in row if each is not None] for row in rows if None not in row]
    if any(len(row) >= _UNMISTAKABLE for row in full):
        return True
    narrow = [row for row in full if len(row) >= _LEAST_COLUMNS]
    return bool(narrow) and all(_are_cylinders(np.array([row])) for row in narrow)


def _are_cylinders(table: Floats) -> bool:
    """Whether the columns of an array, (n, 9 to 15), are those of cylinders."""
    axes = np.linalg.norm(table[:, 5:8], axis=1)
    is_axis = (np.abs(axes - 1.0) < _UNIT_ERROR) | ((axes == 0.0) & (table[:, 1] == 0.0))
    sizes, parent = table[:, :2], table[:, 8]
    is_whole = (parent == np.round(parent)) & (parent >= -1)
    return bool((is_axis & is_whole & (sizes >= 0.0).all(axis=1)).mean() > _LEAST_SHARE)


def _read_mat(path: Path) -> tuple[Cylinders, ...]:
    """Every cylinder model of a MATLAB file."""
    source, trees = str(path), list[Cylinders]()
    variables = read_mat(path)
    tables = [(name, _table(name, model, source)) for name, model in _models(variables)]
    for name, table in tables or _arrays(variables):
        labels = [f'{source}: {name} cylinder {i + 1}' for i in range(len(table))]
        trees.append(_cylinders(table, labels, source))
        trees[-1].name = name
    if not trees:
        what = "no struct with a field 'cylinder', and no array of cylinders"
        cure = 'save the QSM struct of TreeQSM, or its columns as an array of 9 to 15'
        raise FormatError(what, where=source, cure=cure)
    return tuple(trees)


def read_treeqsm_text(path: Path) -> tuple[Cylinders, ...]:
    """Read the cylinders of a TreeQSM text."""
    lines = read_lines(path)
    first = next((i for i, line in enumerate(lines) if line.strip()), 0)
    if lines and all(finite(cell) is None for cell in _cells(lines[first])):
        lines[first] = ''
    names = [f'{field}{"xyz"[axis] * (width > 1)}' for field, width in _FIELDS.items()
             for axis in range(width)]  # fmt: skip
    head = next((line for line in lines if line.strip()), '')
    if len(_cells(head)) == _LEAST_COLUMNS:
        names.remove('extension')
    table = parse_columns(lines, str(path), names, _cells)
    values = table.strict(names)
    labels = [f'{table.where(row)}: cylinder {row + 1}' for row in range(len(values))]
    return (_cylinders(values, labels, str(path)),)


def _cells(line: str) -> list[str]:
    """Cells of a row; commas separate only where neither semicolons nor white space do."""
    cells = line.replace(';', ' ').split()
    return cells if len(cells) >= _LEAST_COLUMNS else line.replace(',', ' ').split()


def _models(variables: dict[str, Any]) -> Iterator[tuple[str, dict[str, Any]]]:
    """Name and columns of each cylinder model, by field name."""
    for name, value in variables.items():
        structs = _structs(value)
        several = len(structs) > 1
        for number, struct in enumerate(structs, start=1):
            inside = next(iter(_structs(struct.get('cylinder', struct))), {})
            if 'radius' in inside:
                yield (f'{name}{number}' if several else name), inside


def _arrays(variables: dict[str, Any]) -> Iterator[tuple[str, Floats]]:
    """Name and columns of each array of cylinders, those of cells as well."""
    for name, value in variables.items():
        if isinstance(value, dict):
            inside = {f'{name}{number}': each for number, each in enumerate(value.values(), 1)}
            yield from _arrays(inside)
        elif isinstance(value, np.ndarray) and value.ndim == 2:
            for table in (value, value.T):
                is_wide = _LEAST_COLUMNS <= table.shape[1] <= _MOST_COLUMNS
                if is_wide and len(table) and _are_cylinders(table.astype(np.float64)):
                    yield name, table[:, :10].astype(np.float64)
                    break


def _structs(value: Any) -> list[dict[str, Any]]:
    if isinstance(value, dict) and all(name.isdigit() for name in value):
        return [each for each in value.values() if isinstance(each, dict)]
    return [value] if isinstance(value, dict) else []


def _table(name: str, fields: dict[str, Any], source: str) -> Floats:
    """Columns of the table of cylinders from fields of their names."""
    columns = []
    for field, width in _FIELDS.items():
        if field not in fields:
            raise FormatError(f"{name} has no numbers '{field}'", where=source)
        try:
            column = numbers(fields[field], field)
        except FormatError as error:
            raise error.at(f'{source}: {name}') from None
        if column.size % width:
            raise FormatError(f'{name}.{field} has {column.size} values', where=source)
        columns.append(column.reshape(-1, width))
    if len({len(column) for column in columns}) > 1:
        raise FormatError('columns of different lengths', where=source, cure='export it again')
    return np.hstack(columns)


def _cylinders(table: Floats, labels: list[str], source: str) -> Cylinders:
    """Cylinders from the columns, (n, 9 or 10), with the name of each row in errors."""
    if len(table) == 0:
        raise FormatError('no cylinders', where=source)
    length, starts, axes, relatives = table[:, 1], table[:, 2:5], table[:, 5:8], table[:, 8:10]
    is_whole = (relatives == np.round(relatives)) & (np.abs(relatives) <= 2**53)
    for row, column in np.argwhere(~is_whole)[:1]:
        what = f'parent or extension is {relatives[row, column]:g}, not a whole number'
        raise FormatError(what, where=labels[row])
    first = 1 + int(relatives[:, 0].min())
    if first not in (0, 1):
        raise FormatError(
            f'the smallest parent is {first - 1}',
            where=source,
            cure='the root has parent 0, or -1',
        )
    family = relatives.astype(np.int64) - first
    above = family[:, 0]
    norm = np.linalg.norm(axes, axis=1)
    for row in np.flatnonzero((norm == 0.0) & (length > 0.0))[:1]:
        raise FormatError('an axis without direction', where=labels[row])
    ends = starts + (length / np.where(norm > 0.0, norm, 1.0))[:, None] * axes
    continues = None
    if family.shape[1] > 1:
        after = family[:, 1]
        valid = (after >= 0) & (after < len(table))
        continues = np.zeros(len(table), dtype=np.bool_)
        child = after[valid]
        continues[child[above[child] == np.flatnonzero(valid)]] = True
    return Cylinders(starts, ends, 2.0 * table[:, [0, 0]], above, continues, labels)


MAT = FileFormat('treeqsm-mat', ('.mat',), looks_like_mat, _read_mat)
TEXT = FileFormat('treeqsm-text', ('.cyl',), _is_text, read_treeqsm_text)
