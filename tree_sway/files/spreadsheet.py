# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Spreadsheets (.xlsx): the rows of their sheets, and the one with an inventory."""

from __future__ import annotations

from dataclasses import replace
from itertools import islice, repeat, zip_longest
from pathlib import Path
from typing import Any
from zipfile import ZipFile

from tree_sway.errors import FormatError
from tree_sway.files.bounded import (
    Arrays,
    bounded_arrays,
    MEMORY,
    packed_rows,
    unpacked_rows,
)
from tree_sway.files.cell_table import table_of_cells
from tree_sway.files.column_names import is_named
from tree_sway.files.layouts.plain import is_known
from tree_sway.files.table_file import TextTable
from tree_sway.files.text_file import MAX_LINES

_CHUNK = 1 << 20
_HEADER = 20
"""Rows that may stand above the header, such as a title."""


def read_spreadsheet(path: Path) -> TextTable:
    """
    Return the rows below the header, which names most columns of an inventory of all sheets.

    A column that has no name there has the one above it, as cells of two rows are joined.
    Raises a `FormatError` for a broken file or no such sheet, and a `MissingDependencyError`
    without openpyxl.
    """
    tables = [
        (rows, number)
        for rows in sheets_of(path)
        for number, cells in enumerate(rows[:_HEADER])
        if sum(map(bool, cells)) >= 2 and number + 1 < len(rows)
    ]
    if not tables:
        raise FormatError('no sheet with a header and rows')
    # A title, or a sheet of other things, may stand above: the header names sizes or species.
    rows, number = max(tables, key=lambda table: _worth(table[0][table[1]]))
    below = {n: row for n, row in enumerate(rows, start=1) if n > number + 1 and any(row)}
    above = rows[number - 1] if number else []
    names = [name or over for name, over in zip_longest(rows[number], above, fillvalue='')]
    table = table_of_cells(names, below.values(), str(path), [*below])
    return replace(table, header_line=number + 1)


def _worth(names: list[str]) -> tuple[int, int]:
    """Return how many sizes of trees names are, and how many are known."""
    sizes = sum(is_named(name, 'diameter', 'girth', 'height') for name in names)
    return min(sizes, 1), sum(map(is_known, names))


def sheets_of(path: Path) -> list[list[list[str]]]:
    """Return the cells of each row of each sheet; errors are as of `read_spreadsheet`."""
    cure = 'save it as .xlsx or .csv again'
    arrays = bounded_arrays(_rows_of_spreadsheet, path, kind='a spreadsheet', cure=cure)
    return [list(unpacked_rows(each)) for each in arrays.values()]


def _rows_of_spreadsheet(path: str) -> Arrays:
    """Yield the rows of texts of each sheet."""
    from openpyxl import load_workbook

    with ZipFile(path) as archive:
        size = sum(each.file_size for each in archive.infolist())
    if size > MEMORY:
        raise ValueError(f'more than {MEMORY >> 20} MiB when it is unpacked')
    has_formulas = _has_formulas(path)
    book = load_workbook(path, read_only=True, data_only=True)
    formulas = load_workbook(path, read_only=True).worksheets if has_formulas else repeat(None)
    for number, (sheet, written) in enumerate(zip(book.worksheets, formulas, strict=False)):
        rows = sheet.iter_rows(values_only=True)
        if written is not None:
            rows = map(_told_formulas, rows, written.iter_rows(values_only=True))
        yield str(number), packed_rows(islice(rows, MAX_LINES))


def _has_formulas(path: str) -> bool:
    """Whether the file may have formulas: they are read from it a second time."""
    with ZipFile(path) as archive:
        for name in archive.namelist():
            if name.startswith('xl/worksheets/') and name.endswith('.xml'):
                with archive.open(name) as sheet:
                    if any(b'</f>' in line for line in iter(lambda: sheet.read(_CHUNK), b'')):
                        return True
    return False


def _told_formulas(cells: tuple[Any, ...], written: tuple[Any, ...]) -> list[Any]:
    """Put formulas that no program has calculated yet in place of their empty cells."""
    return [
        f'formula {formula}, not calculated'
        if cell is None and isinstance(formula, str) and formula.startswith('=')
        else cell
        for cell, formula in zip_longest(cells, written[: len(cells)])
    ]
