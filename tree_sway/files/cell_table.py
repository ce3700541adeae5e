# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Tables of cells that are no lines of text, as those of JSON and of spreadsheets."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from functools import partial

from tree_sway.files.table_file import TextTable

_BETWEEN = '\x1f'


def table_of_cells(
    columns: Sequence[str],
    rows: Iterable[Sequence[str]],
    source: str,
    numbers: Sequence[int] | None = None,
    units: Sequence[str] = (),
    row_name: str = 'line',
) -> TextTable:
    """
    Return a table from the cells of its rows.

    ``numbers`` count the rows in the file, where one is called ``row_name``.
    """
    texts = [_BETWEEN.join(row) for row in rows]
    lines = range(1, len(texts) + 1) if numbers is None else numbers
    split = partial(str.split, sep=_BETWEEN)
    return TextTable(
        tuple(columns), lines, texts, split, source, units=tuple(units), row_name=row_name
    )


NumberedRow = tuple[int, Sequence[str]]
"""Number of a line in the file, from 1, and the cells of that line."""


def numbered(lines: Sequence[str], begin: int = 0) -> Iterator[tuple[int, str]]:
    """Yield the lines of a file from an index on, each after its number, from 1."""
    return enumerate(lines[begin:], start=begin + 1)


def cell_at(cells: Sequence[str], place: int | None) -> str:
    """Return a cell without spaces around it; empty where a row has no such place."""
    if place is None or place >= len(cells):
        return ''
    return cells[place].strip()


def table_of_lines(
    columns: Sequence[str], rows: Iterable[NumberedRow], source: str, units: Sequence[str] = ()
) -> TextTable:
    """Return a table from the lines of a file that have a row."""
    numbered = list(rows)
    numbers = [number for number, _ in numbered]
    cells = [row for _, row in numbered]
    return table_of_cells(columns, cells, source, numbers, units)
