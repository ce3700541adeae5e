# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Columns of an inventory, and which of its rows are left out and why."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
import re

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.arrays import Floats
from tree_sway.files.column_names import INVENTORY, is_named, unit_factor, unit_known
from tree_sway.files.scenes.inventory.cell_number import cell_number, stems_number
from tree_sway.files.table_file import are_nines, Column, TextTable

_NUMBERED = re.compile(r'(?<=[^\W\d])[ _]?[1-9](?=$|[ _(\[])')
"""Number of a stem in the name of a column."""
SPECIES = 'the species'


def missing_columns(table: TextTable) -> list[str]:
    """Describe the columns of an inventory that a table lacks."""
    return [
        what
        for what, choices in INVENTORY.items()
        if not any(all(map(table.find_all, choice.split())) for choice in choices)
    ]


class InventoryColumns:
    """
    Columns of a table by their quantity, with its used ones, assumptions, and rows left out.

    Parameters
    ----------
    table
        The table; its rows are counted from 0.

    """

    def __init__(self, table: TextTable) -> None:
        self.table = table
        self.n_rows = len(table.texts)
        self.used = set[int]()
        self.notes = list[str]()
        self.is_in_states = False
        """Whether all places are known to be in the United States."""
        self.has_inches = False
        """Whether stems are in inches, so that heights may be in feet."""
        self.is_kept: NDArray[np.bool_] = np.ones(self.n_rows, dtype=np.bool_)
        self._texts: dict[int, list[str]] = {}
        self._reasons = Counter[str]()
        self._first = ''

    def note(self, *notes: str) -> None:
        """Add assumptions that are not empty and not yet there."""
        self.notes += [note for note in notes if note and note not in self.notes]

    def leave_out(self, row: int, reason: str, detail: str) -> None:
        """Leave a row out for a reason; the first is told in detail, with its line."""
        if not self.is_kept[row]:
            return
        self.is_kept[row] = False
        self._reasons[reason] += 1
        if not self._first:
            self._first = f'{self.line(row)}: {detail}'

    def why_left_out(self) -> str:
        """Return how many rows were left out, why, and the first; empty without one."""
        if not self._reasons:
            return ''
        reasons = ', '.join(f'{count} {reason}' for reason, count in self._reasons.most_common())
        count = sum(self._reasons.values())
        return (
            f'{count} {"row is" if count == 1 else "rows are"} left out: {reasons}; {self._first}'
        )

    def numbered(self, quantity: str) -> list[int]:
        """Places of columns of the stems of a tree, as ``DBH 1 (cm)`` and ``DBH 2 (cm)``."""
        names = enumerate(self.table.columns)
        return [i for i, name in names if is_named(_NUMBERED.sub('', name), quantity)]

    def index_of(self, quantity: str) -> int | None:
        """Place of the first column of a quantity; None without one."""
        return next(iter(self.table.find_all(quantity)), None)

    def line(self, row: int) -> str:
        """Name a row as its file counts it."""
        return f'{self.table.row_name} {self.table.numbers[row]}'

    def cell(self, index: int, row: int) -> str:
        """Text of a cell, cut to what is shown of it."""
        return self.table.cells(index, [row])[0][:40]

    def told(self, index: int, row: int) -> str:
        """Name of a column, and its cell in a row."""
        return f"{self.table.columns[index]} is '{self.cell(index, row)}'"

    def texts_of(self, quantity: str) -> list[str]:
        """Texts of the first column of a quantity; empty ones without it."""
        index = self.index_of(quantity)
        return [''] * self.n_rows if index is None else self.texts(index)

    def find(self, *quantities: str) -> list[Column] | None:
        """Columns of quantities; None if one is missing."""
        found = [self.table.find(each) for each in quantities]
        return None if None in found else [each for each in found if each is not None]

    def texts(self, index: int) -> list[str]:
        """Texts of a column."""
        self.used.add(index)
        if index not in self._texts:  # splitting lines takes most of the time of long tables
            self._texts[index] = self.table.cells(index, self.table.rows)
        return self._texts[index]

    def numbers(self, index: int, *, stems: bool = False, unit: str = '') -> tuple[Floats, str]:
        """
        Numbers of a column, NaN where a cell has none, and their unit, if one is known.

        It is the ``unit`` of the header if given, else that of most cells. Numbers of cells with
        another one are converted to it; where only a few cells have one, they are turned into
        metres. A cell may have several ``stems``, which count as one of their whole section.
        """
        values = np.full(self.n_rows, np.nan)
        units = [''] * self.n_rows
        n_ranges = 0
        n_several = 0
        unread = list[int]()
        for row, text in enumerate(self.texts(index)):
            if not self.is_kept[row]:
                continue
            found = stems_number(text) if stems else cell_number(text)
            if found is None:
                if stems and any(map(str.isdigit, text)):
                    unread.append(row)
                continue
            values[row], units[row] = found
            n_several += found != cell_number(text)
            is_range = re.search(r'\S\s*[-/]', text) is not None
            n_ranges += is_range and found == cell_number(text)
        self._drop_nines(values, index)
        name = self.table.columns[index]
        if unread:
            first = f"{self.line(unread[0])} is '{self.cell(index, unread[0])}'"
            self.note(f'{len(unread)} cells of {name} cannot be read: {first}')
        if n_several:
            self.note(f'{n_several} cells of {name} have several stems: one of their section')
        if n_ranges:
            self.note(f'{n_ranges} cells of {name} are ranges: their middles')
        return values, self._in_one_unit(values, units, index, unit)

    def _drop_nines(self, values: Floats, index: int) -> None:
        """Take ``99``, ``999`` and so on for a missing value where no other is nearly as large."""
        cells = self.texts(index)
        is_code = are_nines(cells, values)
        if is_code.any():
            name, cell = self.table.columns[index], cells[int(np.argmax(is_code))]
            self.note(f"{is_code.sum()} cells of {name} such as '{cell}' are taken as missing")
            values[is_code] = np.nan

    def _in_one_unit(self, values: Floats, units: Sequence[str], index: int, header: str) -> str:
        """Convert numbers of cells with a unit of their own to that of all, and return it."""
        counts = Counter(unit for unit in units if unit)
        if not counts:
            return header
        unit = header if unit_known('length', header) else counts.most_common(1)[0][0]
        n_without = int(np.isfinite(values).sum()) - counts.total()
        name = self.table.columns[index]
        if unit != header and counts.total() < n_without:
            self.note(f'{counts.total()} cells of {name} have a unit of their own')
            unit = ''
        elif unit != header and n_without:
            self.note(f'{n_without} cells of {name} without a unit are taken as {unit}')
        of_all = unit_factor('length', unit) if unit else 1.0
        for row, own in enumerate(units):
            factor = unit_factor('length', own) if own else None
            if factor is not None and of_all is not None:
                values[row] *= factor / of_all
        return unit
