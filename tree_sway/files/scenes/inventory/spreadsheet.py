# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Spreadsheets (.xlsx) as tables: the first sheet with a header of an inventory."""

from __future__ import annotations

from itertools import islice
from pathlib import Path
from typing import Any
from zipfile import ZipFile

from tree_sway.errors import FormatError, MissingDependencyError
from tree_sway.extras import cure_of_missing
from tree_sway.files.cell_table import table_of_cells
from tree_sway.files.column_names import rank_of
from tree_sway.files.table_file import TextTable
from tree_sway.files.text_file import MAX_LINES, reason_of

_QUANTITIES = ('species', 'genus', 'height', 'diameter', 'girth', 'x', 'latitude', 'place')
_CHUNK = 1 << 20
_HEADER = 20
"""Rows that may stand above the header, such as a title."""


def read_spreadsheet(path: Path) -> TextTable:
    """
    Return the rows below the header, which names most columns of an inventory of all sheets.

    Raises a `FormatError` for a broken file or no such sheet, and a `MissingDependencyError`
    without openpyxl.
    """
    try:
        from openpyxl import load_workbook
    except ModuleNotFoundError:
        cure = cure_of_missing('openpyxl')
        raise MissingDependencyError("No module named 'openpyxl'", cure=cure) from None
    try:
        book = load_workbook(path, read_only=True, data_only=True)
        sheets = [list(_rows(sheet)) for sheet in book.worksheets]
        if _has_formulas(path):
            formulas = load_workbook(path, read_only=True).worksheets
            for rows, sheet in zip(sheets, formulas, strict=True):
                _tell_formulas(rows, sheet)
    except Exception as error:  # of zip, of XML, of the format: openpyxl has no root of its own
        what = f'no spreadsheet that can be read: {reason_of(error)}'
        raise FormatError(what, where=str(path), cure='save it as .xlsx or .csv again') from None
    tables = [
        (rows, number)
        for rows in sheets
        for number, cells in enumerate(rows[:_HEADER])
        if sum(map(bool, cells)) >= 2 and number + 1 < len(rows)
    ]
    if not tables:
        raise FormatError('no sheet with a header and rows', where=str(path))
    # A title, or a sheet of other things, may stand above: the header names species or sizes.
    rows, number = max(tables, key=lambda table: _n_known(table[0][table[1]]))
    below = [row for row in rows[number + 1 :] if any(row)]
    lines = [n for n, row in enumerate(rows, start=1) if n > number + 1 and any(row)]
    return table_of_cells(rows[number], below, str(path), lines)


def _n_known(cells: list[str]) -> int:
    """Count of the quantities of an inventory that a row names."""
    names = [cell for cell in cells if cell]
    return sum(any(rank_of(name, each) is not None for name in names) for each in _QUANTITIES)


def _has_formulas(path: Path) -> bool:
    """Whether the file may have formulas: they are read from it a second time."""
    with ZipFile(path) as archive:
        for name in archive.namelist():
            if name.startswith('xl/worksheets/') and name.endswith('.xml'):
                with archive.open(name) as sheet:
                    if any(b'</f>' in line for line in iter(lambda: sheet.read(_CHUNK), b'')):
                        return True
    return False


def _tell_formulas(rows: list[list[str]], sheet: Any) -> None:
    """Put formulas that no program has calculated yet in place of their empty cells."""
    for cells, written in zip(rows, sheet.iter_rows(values_only=True), strict=False):
        for column, formula in enumerate(written[: len(cells)]):
            if not cells[column] and isinstance(formula, str) and formula.startswith('='):
                cells[column] = f'formula {formula}, not calculated'


def _rows(sheet: Any) -> Any:
    """Texts of the cells of each row."""
    for row in islice(sheet.iter_rows(values_only=True), MAX_LINES):
        yield ['' if cell is None else str(cell).replace('\x1f', ' ') for cell in row]
