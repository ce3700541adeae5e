# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Tables of cells that are no lines of text, as those of JSON and of spreadsheets."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from tree_sway.files.table_file import TextTable


def table_of_cells(
    columns: Sequence[str],
    rows: Iterable[Sequence[str]],
    source: str,
    numbers: Sequence[int] = (),
    units: Sequence[str] = (),
    row_name: str = 'line',
) -> TextTable:
    """
    Return a table from the cells of its rows.

    ``numbers`` count the rows in the file, where one is called ``row_name``.
    """
    kept = [*map(tuple, rows)]
    lines = numbers or range(1, len(kept) + 1)
    return TextTable(
        tuple(columns), lines, kept, tuple, source, units=tuple(units), row_name=row_name
    )
