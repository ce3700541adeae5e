# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Tables in text: one mapper from columns to arrays for every format of the family.

Comma, semicolon or tab between cells, white space where a format has no header; units are in
brackets after a column's name, or in a separate row. Cells are read when needed, a block at a
time, as a day of wind has millions of rows.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
import csv
from dataclasses import dataclass, replace
from functools import partial
import re
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.arrays import Floats, Ints
from tree_sway.errors import FormatError, TreeError
from tree_sway.files.column_names import (
    COLUMNS,
    folded,
    is_name,
    name_and_unit,
    rank_of,
    SENDERS,
    unit_factor,
    unit_in_name,
    unit_known,
    UNITS,
    year_of,
)
from tree_sway.files.text_file import finite, why_no_number

SEPARATORS = '\t;|,'
"""Signs between cells; of two that a header has as often, the first."""
_MAX_COLUMNS = 10_000
_MOST_LINES = 50
"""Lines of a row at most."""
_MOST_UNITS = 6
_LOOKED_AT = 200
"""Rows that are looked at for whether a column has a cell."""
_MEND = 'correct the cell or remove the row'
_NAME = 'write names and units of its columns above it, as time,u [m/s],v or time,ax [g]'
_STAMP_LETTERS = re.compile(r'(?<=\d)[TZ]')
_WORDS = re.compile(r'\w[^\s:]*(?:\s+[\w/][^\s:]*){2,}')
_THOUSANDS = re.compile(r'(?<=\d)\.(?=\d{3}(?:\.\d{3})*,\d)')
"""Point between the thousands of a number with a decimal comma."""
_NINES = re.compile(r'99+(?:[.,][09]+)?')
_MUCH = 4.0
"""Times the largest other number that a code of a missing value is."""
_POINT = re.compile(r'(?<![\d.:])\d+\.\d+(?![\d.])')  # no 01.03.2024 and no 07:58:00.25


@dataclass(frozen=True, slots=True)
class Column:
    """Place of a column in a table, and the factor from its unit to SI."""

    index: int
    factor: float


@dataclass(frozen=True)
class TextTable:
    """
    A table whose columns have names: number and text of each line, and how to split it.

    Where the rows are no text but cells, these are the texts.
    ``header_line`` and ``unit_line`` are the lines of names and units; ``units`` are those of the
    columns, if they are in a separate row. ``row_name`` is the name of a row in messages.
    ``above`` are the lines above the header, ``note`` is what its reader has to be told.
    """

    columns: tuple[str, ...]
    numbers: Sequence[int]
    texts: Sequence[Any]
    split: Callable[[Any], Sequence[str]]
    source: str
    header_line: int = 1
    unit_line: int = 1
    units: tuple[str, ...] = ()
    row_name: str = 'line'
    above: tuple[str, ...] = ()
    note: str = ''

    @property
    def rows(self) -> range:
        """Rows of the table, from 0."""
        return range(len(self.texts))

    def part(self, rows: Iterable[int], name: str = '') -> TextTable:
        """Return the table of some rows, under a name behind that of its file."""
        kept = list(rows)
        numbers, texts = ([of_all[row] for row in kept] for of_all in (self.numbers, self.texts))
        return replace(self, numbers=numbers, texts=texts, source=f'{self.source}{name}')

    def where(self, row: int | None = None) -> str:
        """File and line of a row, or of the header."""
        return f'{self.source}:{self.header_line if row is None else self.numbers[row]}'

    def error(self, what: str, row: int | None = None, cure: str = '') -> FormatError:
        """Make an error of a row, or of the header."""
        return FormatError(what, where=self.where(row), cure=cure)

    def index_of(self, name: str) -> int:
        """Position of a column, in any case of letters; a `FormatError` if it is missing."""
        for index, column in enumerate(self.columns):
            if column.lower() == name.lower():
                return index
        raise self.error(
            f"no column '{name}' among {', '.join(self.columns[:20])}",
            cure='export it with its header line, unchanged',
        )

    def known_factor(self, kind: str, unit: str) -> float:
        """Factor of a unit to SI; a `FormatError` if it is not one of a kind."""
        return known_factor(kind, unit, f'{self.source}:{self.unit_line}')

    def find(self, quantity: str) -> Column | None:
        """Return the column of a quantity of `COLUMNS` whose name comes first there, or None."""
        found = self.find_all(quantity)
        return Column(found[0], self.factor_of(found[0], quantity)) if found else None

    def find_all(self, quantity: str) -> list[int]:
        """Places of a quantity's columns in the order of their names, empty and old ones last."""
        ranks = [
            (rank, -year_of(column), index)
            for index, column in enumerate(self.columns)
            if (rank := rank_of(column, quantity)) is not None
        ]
        found = [index for _, _, index in sorted(ranks)]
        first = self.rows[:_LOOKED_AT] if len(found) > 1 else ()
        return sorted(found, key=lambda each: not any(self.cells(each, first)))

    def factor_of(self, index: int, quantity: str) -> float:
        """Factor to SI of a column of a quantity; a `FormatError` for an unknown unit."""
        kind = COLUMNS[quantity]['unit']
        default = unit_factor(kind, COLUMNS[quantity].get('default', ''))
        unit = self.unit_of(index, quantity)
        if not unit or not UNITS.get(kind):
            return 1.0 if default is None else default
        return self.known_factor(kind, unit)

    def unit_of(self, index: int, quantity: str) -> str:
        """Return the unit of a column of a quantity as it is written; empty without one."""
        column, kind = self.columns[index], COLUMNS[quantity]['unit']
        name, unit = name_and_unit(column, kind)
        if not unit_known(kind, unit) and is_name(column, quantity):
            unit = ''  # brackets that are part of the name: avg wind speed (10min)
        row = self.units[index] if index < len(self.units) else ''
        return unit or unit_in_name(name, quantity) or row.strip()

    def values(self, indices: Iterable[int]) -> Floats:
        """Numbers in some columns, NaN where a cell is not a number, (n, k)."""
        columns = list(indices)
        result = np.empty((len(self.texts), len(columns)))
        for row, text in enumerate(self.texts):
            cells = self.split(text)
            result[row] = [finite(cells[each]) if each < len(cells) else None for each in columns]
        return result

    def strict(self, names: Sequence[str]) -> Floats:
        """
        Numbers in the columns of these names, (n, k).

        Raises a `FormatError` for the first row that is short or has no finite number.
        """
        indices = [self.index_of(name) for name in names]
        values = self.values(indices)
        for row, column in np.argwhere(np.isnan(values))[:1]:
            raise self.error(self.why_none(row, [indices[column]]), row, _MEND)
        return values

    def why_none(self, row: int, indices: Iterable[int]) -> str:
        """Describe the cell of a row that is missing or not a number."""
        cells = self.split(self.texts[row])
        for index in indices:
            if index >= len(cells):
                return f"{len(cells)} cells, none for '{self.columns[index]}'"
            if finite(cells[index]) is None:
                return f'{self.columns[index]} is {why_no_number(cells[index])}'
        return 'not a row of numbers'

    def whole(self, values: Floats, name: str) -> Ints:
        """Return a column of whole numbers; a `FormatError` for fractions or out of range."""
        for row in np.flatnonzero((values != np.round(values)) | (np.abs(values) > 2**53))[:1]:
            raise self.error(f'{name} is {values[row]:g}, not a whole number', row)
        return values.astype(np.int64)

    def cells(self, index: int, rows: Iterable[int]) -> list[str]:
        """Texts of a column in some rows; empty where a row is short."""
        split = (self.split(self.texts[row]) for row in rows)
        return [row[index] if index < len(row) else '' for row in split]

    def rows_by(self, index: int) -> dict[str, list[int]]:
        """Rows of each text in a column."""
        rows: dict[str, list[int]] = {}
        for row, text in enumerate(self.cells(index, self.rows)):
            rows.setdefault(text, []).append(row)
        return rows

    def refuse_several(self) -> None:
        """Refuse rows of several instruments, told by a column that names them."""
        size = len(self.columns)
        for index, name in enumerate(self.columns):
            if folded(name_and_unit(name, '')[0]) in SENDERS[:-1]:
                rows = map(self.split, self.texts)
                found = sorted({row[index] for row in rows if len(row) == size} - {'', name})
                if len(found) > 1:
                    raise self.error(
                        f'rows of {len(found)} instruments: {", ".join(found[:4])}',
                        cure='write a table for each',
                    )

    def family(
        self, number: str, parent: str, none: Sequence[int], what: str
    ) -> tuple[list[str], Ints]:
        """
        Return the name of each row in errors (``what`` and number), and its parent's row, or -1.

        Without a name of the column of numbers, these are those of the rows, from 1.
        ``none`` are the parent numbers that mean no parent. A number that occurs twice is a
        `FormatError`, a missing parent a `TreeError`.
        """
        own = self.strict([number])[:, 0] if number else np.arange(1.0, len(self.texts) + 1.0)
        numbers = self.whole(own, number).tolist()
        labels = [f'{self.where(row)}: {what} {each}' for row, each in enumerate(numbers)]
        position: dict[int, int] = {}
        for row, each in enumerate(numbers):
            if position.setdefault(each, row) != row:
                raise FormatError(f'number {each} occurs twice', where=labels[row])
        parents = np.full(len(numbers), -1, dtype=np.int64)
        for row, each in enumerate(self.whole(self.strict([parent])[:, 0], parent).tolist()):
            if each in position:
                parents[row] = position[each]
            elif each not in none:
                raise TreeError(
                    f'orphan: its parent {each} is not in the file',
                    where=labels[row],
                    cure=f'name one that is, or {none[0]} for the root',
                )
        return labels, parents


def are_nines(cells: Sequence[str], values: Floats) -> NDArray[np.bool_]:
    """Mark codes of missing values, such as ``999``, where no other value is nearly as large."""
    is_code = np.array([_NINES.fullmatch(cell.strip()) is not None for cell in cells], np.bool_)
    others = values[~is_code & np.isfinite(values)]
    return np.asarray(is_code & (len(others) > 0) & (values > _MUCH * np.max(others, initial=0.0)))


def known_factor(kind: str, unit: str, where: str) -> float:
    """Factor of a unit to SI; a `FormatError` that names usual ones if it is not of the kind."""
    factor = unit_factor(kind, unit)
    if factor is None:
        usual: dict[float, str] = {}
        for name, each in UNITS[kind].items():
            usual.setdefault(each, name)
        cure = f'use {", ".join([*usual.values()][:_MOST_UNITS])}'
        raise FormatError(f"unknown unit '{unit[:20]}'", where=where, cure=cure)
    return factor


def split_row(line: str, separator: str) -> Sequence[str]:
    """Cells of one line, stripped; quoted cells may contain the separator but no line end."""
    if separator == ' ':
        return line.split()
    if '"' not in line:
        return list(map(str.strip, line.split(separator)))
    try:
        return list(map(str.strip, next(csv.reader([line], delimiter=separator))))
    except csv.Error:
        return []


def separator_of(header: str) -> str:
    """Return the sign between the cells of a header, the one that it has most; else a space."""
    found = '\t' if header.count('\t') > 1 else max(SEPARATORS, key=header.count)
    return found if found in header or not _WORDS.fullmatch(header.strip()) else ' '


def whole_rows(
    numbers: Sequence[int], texts: Sequence[str], separator: str
) -> tuple[list[int], list[str]]:
    """
    Join lines of which a quoted cell has a line end, as spreadsheets write remarks.

    A row has no more cells than the first. A quote that is not closed so is part of its line.
    """
    kept = list[int]()
    rows = list[str]()
    at = 0
    while at < len(texts):
        row = texts[at]
        count = 1
        if row.count('"') % 2:
            most = len(split_row(rows[0], separator)) if rows else _MAX_COLUMNS
            row, count = _joined(texts[at : at + _MOST_LINES], separator, most)
        kept.append(numbers[at])
        rows.append(row)
        at += count
    return kept, rows


def _joined(lines: Sequence[str], separator: str, most: int = _MAX_COLUMNS) -> tuple[str, int]:
    """
    Return the row that begins in the first line, and how many lines it has.

    It has at most so many cells. Without a separator, which is not known yet, a row of several
    lines begins with its quote.
    """
    begins = rf'(?:^|{re.escape(separator)})\s*"' if separator else r'^\s*"'
    is_open = lines[0].count('"') % 2 == 1 and re.search(begins, lines[0]) is not None
    for count in range(2, len(lines) + 1 if is_open else 0):
        row = ' '.join(lines[:count])
        if row.count('"') % 2 == 0:
            is_row = not separator or 0 < len(split_row(row, separator)) <= most
            return (row, count) if is_row else (lines[0], 1)
    return lines[0], 1


def filled_lines(lines: Sequence[str]) -> tuple[list[int], list[str]]:
    """Numbers and texts of the lines that are neither blank nor a comment."""
    filled = [
        number
        for number, line in enumerate(lines, start=1)
        if line.strip() and not line.lstrip().startswith(('#', 'sep='))
    ]
    return filled, [lines[number - 1] for number in filled]


def parse_table(lines: Sequence[str], source: str) -> TextTable:
    """
    Parse a table whose first line that is neither blank nor a comment is the header.

    Raises a `FormatError` for no header, no row, or most rows with more cells than the header.
    """
    numbers, texts = filled_lines(lines)
    if len(texts) < 2:
        raise FormatError('no header and rows', where=source, cure='give a header and rows')
    header, _ = _joined(texts[:_MOST_LINES], '')
    separator = separator_of(header)
    cells = split_row(header, separator)
    filled = list(filter(None, cells if len(cells) > 1 else header.split()))
    has_names = any(map(str.isalpha, _STAMP_LETTERS.sub('', header)))
    if (
        (len(cells) < 2 and '"' not in header)
        or not has_names
        or 2 * sum(finite(each) is not None for each in filled) > len(filled)
    ):
        raise FormatError(
            f"no header: the first line, '{header[:40].strip()}', has no names",
            where=f'{source}:{numbers[0]}',
            cure=_NAME,
        )
    if any('"' in text for text in texts):
        numbers, texts = whole_rows(numbers, texts, separator)
        if len(texts) < 2:
            raise FormatError(
                'no header and rows: a quote is open from the header to the end',
                where=f'{source}:{numbers[0]}',
                cure='close it in the header',
            )
    # A line of one cell is a remark, with numbers of its own.
    first = '\n'.join(text for text in texts[1:50] if separator in text.rstrip(separator))
    if separator != ',' and re.search(r'\d,\d', first) and not _POINT.search(first):
        texts[1:] = [_THOUSANDS.sub('', text).replace(',', '.') for text in texts[1:]]
    split = partial(split_row, separator=separator)
    columns = tuple(split(texts[0]))
    if len(columns) > _MAX_COLUMNS:
        raise FormatError(f'a header of {len(columns)} columns', where=f'{source}:{numbers[0]}')
    first_line = numbers[0]
    table = TextTable(columns, numbers[1:], texts[1:], split, source, first_line, first_line)
    long = [row for row, text in enumerate(table.texts) if any(split(text)[len(columns) :])]
    if 2 * len(long) > len(table.texts):
        raise table.error(
            f'more cells than the {len(columns)} columns of the header, as in most rows',
            long[0],
            'name every column right above the rows, or export decimal commas as points',
        )
    return table


def parse_columns(
    lines: Sequence[str],
    source: str,
    columns: Sequence[str],
    split: Callable[[str], Sequence[str]] = str.split,
) -> TextTable:
    """Parse a table without a header, with given columns."""
    numbers, texts = filled_lines(lines)
    return TextTable(tuple(columns), numbers, texts, split, source)
