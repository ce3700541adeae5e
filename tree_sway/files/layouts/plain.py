# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A table with a header, maybe below lines that a program puts before it, such as a place.

The header may be a comment. Rows without a number may be below it, one of which has units.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache
from itertools import takewhile
import re

from tree_sway.files.column_names import (
    COLUMNS,
    HEADER,
    is_named,
    motion_of,
    name_and_unit,
    unit_known,
)
from tree_sway.files.layouts.layout import Layout
from tree_sway.files.table_file import parse_table, separator_of, split_row, TextTable

_HEAD = 200
_CAMPBELL = '"TOA5"', 'TOA5'
_HEAD_ENDS = '***End_of_Header***'
_MOST_COLUMNS = 200
_MOST_BELOW = 3
_NUMBER = re.compile(r'[-+]?[\d.,:]+(?:[eE][-+]?\d+)?|nan|NaN|NULL|null')
_REMARK = re.compile(r'(?:[^\W\d]|[ .:])*[,;\t]*')
"""One cell of words in a last line."""
_BETWEEN = re.compile(r'[,;:=\t|()\[\]]|\bin\b')
"""What is between a name, what it means and its unit."""
_COMMENTED = re.compile(r'#|%|//|;[^;]*$|[\w\s]*\w{3}\.\s*$')
_PLACE = re.compile(
    r'(?:(?!wind).)*?(?=wind)|(?:(?!'
    r'(?:crown|canopy|krone|couronne|houppier|kroon|copa|chioma|koruna|branch|ast|leaf|root)[ _]'
    r').*[ _])?',
    re.IGNORECASE,
)
_DIGIT = re.compile(r'[-+]?\.?\d')
_COMMENT = re.compile(r'(?:[#%/ ]+|;) *(?:[Hh]eaders\s*,)? *')
_PARTS = ('yyyymmdd', 'yyyy', 'year', 'yy', 'mess_datum', 'hora utc', 'vuosi')
_ABOUT_UNIT = re.compile('unit|unidad|einheit|eenheid', re.IGNORECASE)
_KINDS = ('speed', 'acceleration', 'rate')
"""Kinds of units of which a row of units has at least one."""
_SIZES = ('height', 'diameter', 'girth')


def header_line(lines: Sequence[str]) -> int | None:
    """
    Line of the header: the first of those that name most quantities.

    A comment is one only where no other line names two. It is below the heads of LabVIEW. A line
    with numbers is a row where one above it that names two has as many cells and no number.
    """
    plain: dict[int, int] = {}
    hashed: dict[int, int] = {}
    ends = (number for number, line in enumerate(lines[:_HEAD]) if line.startswith(_HEAD_ENDS))
    first = max(ends, default=0)
    sizes = set[int]()
    for number, line in enumerate(lines[first:_HEAD], start=first):
        filled = list(filter(None, _cells(line)))
        n_numbers = sum(_NUMBER.fullmatch(cell) is not None for cell in filled)
        is_comment = _is_comment(line)
        if is_comment:
            filled = _cells(_uncommented(line))
        if len(filled) > 1 and 2 * n_numbers <= len(filled):
            count = sum(map(is_known, {*_without_place(filled[:_MOST_COLUMNS])}))
            size = len(_cells(line))
            if n_numbers and size in sizes:
                continue
            if count > 1 and not n_numbers:
                sizes.add(size)
            (hashed if is_comment else plain)[number] = count
    found = plain if max(plain.values(), default=0) > 1 else plain | hashed
    most = max(found, key=lambda number: found[number], default=None)
    return most if most is not None and found[most] else None


def _is_comment(line: str) -> bool:
    """Whether a line is a comment or prose; a semicolon before the others is an empty cell."""
    return _COMMENTED.match(line) is not None


def _uncommented(line: str) -> str:
    return _COMMENT.sub('', line, count=1) if _is_comment(line) else line


def _cells(line: str) -> list[str]:
    return list(split_row(line, separator_of(line)))


@lru_cache(4096)
def is_known(cell: str) -> bool:
    """Whether a cell is the name of a column that is known."""
    if not cell or _NUMBER.fullmatch(cell) or cell.lower() in _PARTS:
        return cell.lower() in _PARTS
    motion = motion_of(cell)
    is_axis = motion is not None and motion[2] != ''
    return is_axis or is_named(cell, *HEADER)


def _is_table(lines: Sequence[str]) -> bool:
    found = header_line(lines)
    cells = [] if found is None else _cells(_uncommented(lines[found]))
    return any(is_named(cell, 'time') or cell.lower() in _PARTS for cell in cells)


def _read(lines: list[str], source: str) -> TextTable:
    while len(lines) > 1 and _REMARK.fullmatch(lines[-1]):
        lines.pop()
    lines = lines or ['']
    first = header_line(lines) or 0
    above = tuple(lines[:first])
    lines[:first] = [''] * first
    header = _uncommented(lines[first])
    # Of NDBC's two columns mm and MM one is the minute.
    header = header.replace(' mm ', ' minute ') if ' MM ' in header else header
    below = _cells(lines[first + 1]) if len(lines) > first + 1 else []
    if not any(map(_DIGIT.match, below)):  # names may go on beside the units, as of Kestrel
        sign = separator_of(header)
        header = sign.join((header, *below[len(split_row(header, sign)) :]))
    lines[first] = header
    table = parse_table(lines, source)
    names = tuple(_without_place(table.columns))
    return _without_rows_of_units(replace(table, columns=names, above=above))


def _without_place(names: Sequence[str]) -> Sequence[str]:
    """
    Return names without the place or thing that all unknown ones begin with.

    Where none is known those of three in four do. So are ``Basel Wind Speed`` and ``pl_dbh``; the
    parts of a tree, as ``crown``, are kept.
    """
    unknown = [name for name in names if not is_known(name)]
    begins = Counter(name[:2] for name in unknown)
    # Without another name that is known a few may begin otherwise.
    others = len(unknown) // 4 if len(unknown) == len(names) else 0
    most = [name for name in unknown if begins[name[:2]] >= len(unknown) - others]
    letters = zip(*most, strict=False) if len(most) > 1 else ()
    alike = ''.join(each[0] for each in takewhile(lambda each: len({*each}) == 1, letters))
    place = next(_PLACE.finditer(alike))[0]
    short = [name if is_known(name) else name.removeprefix(place) for name in names]
    return short if any(map(is_known, {*short} - {*names})) else names


def _without_rows_of_units(table: TextTable) -> TextTable:
    """
    Return a table without the rows of units and of other words below its header.

    It is itself without a row of units; one above the header has as many cells as that, but for
    a remark at its end, and none of its names. This may have names too, as in ``風速(m/s)`` below
    ``WS``.
    """
    words = []
    for text in table.texts[:_MOST_BELOW]:
        cells = [cell.strip('"') for cell in table.split(text)]
        if any(map(_DIGIT.match, cells)):
            break
        words.append([_unit_below(cell) for cell in cells])
    split = map(table.split, table.above)
    size = len(table.columns)
    alike = (row for row in split if max(size - 2, 2) < len(row) <= size)
    told = (row for row in alike if not {*row} & {*table.columns})
    above = [[*map(_unit_below, row)] for row in told]
    is_campbell = any(line.startswith(_CAMPBELL) for line in table.above)
    rows = [row for row in (*words, *above) if is_campbell or _are_units(table, row)]
    if not rows:
        return replace(table, units=units_above(table, table.above))
    below = len(words) if rows[0] in words else 0
    units = [
        '' if is_named(name, 'time') and not unit_known('time', cell) else cell
        for name, cell in zip(table.columns, rows[0], strict=False)
    ]
    return replace(
        table.part(table.rows[below:]),
        units=tuple(units),
        unit_line=table.numbers[words.index(rows[0])] if below else table.header_line,
    )


def units_above(table: TextTable, above: Sequence[str]) -> tuple[str, ...]:
    """
    Return units of columns that lines tell, as ``# WSPD: wind speed (knots)``; may be empty.

    A speed that no line names has the unit which all lines about a unit tell, as ``Units,mph``.
    """
    said = [
        [part.strip('#%/" ') for part in (*_BETWEEN.split(line), *line.split())] for line in above
    ]
    settings = [part for line in said if _ABOUT_UNIT.search(line[0]) for part in line[1:]]
    speeds = {part for part in settings if unit_known('speed', part)}
    of_all = speeds.pop() if len(speeds) == 1 else ''

    def unit_of(column: str) -> str:
        kinds = [COLUMNS[each]['unit'] for each in HEADER if is_named(column, each)]
        parts = (part for line in said if column in line for part in line if part != column)
        known = (part for part in parts if any(unit_known(kind, part) for kind in kinds))
        return next(known, of_all if is_named(column, 'wind_speed', 'gust') else '')

    return tuple(map(unit_of, table.columns))


def _are_units(table: TextTable, cells: Sequence[str]) -> bool:
    """Whether a row has a unit of a wind or a motion, or lengths below sizes."""
    if any(unit_known(kind, cell) for cell in cells for kind in _KINDS):
        return True
    pairs = zip(table.columns, cells, strict=False)
    return any(
        unit_known(COLUMNS[size]['unit'], cell) and is_named(name, size)
        for name, cell in pairs
        for size in _SIZES
    )


def _unit_below(cell: str) -> str:
    """Return a unit in brackets behind a name or alone; a cell without brackets as it is."""
    name, unit = name_and_unit(cell, 'speed')
    if any(unit_known(kind, cell) for kind in _KINDS) or (name == cell and not unit):
        return cell.strip('[]')
    return unit if any(unit_known(kind, unit) for kind in ('angle', 'time', *_KINDS)) else ''


PLAIN = Layout(_is_table, _read)
