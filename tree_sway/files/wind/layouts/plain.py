# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A table with a header, maybe below lines that a service puts before it, such as a place.

The header may begin with a hash, and a row of units may be below it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
import re

from tree_sway.files.column_names import name_and_unit, rank_of, unit_known
from tree_sway.files.table_file import parse_table, SEPARATORS, TextTable
from tree_sway.files.text_file import finite
from tree_sway.files.wind.layouts.layout import Layout

_HEAD = 40
_MOST_COLUMNS = 200
_CELL = re.compile(rf'[{SEPARATORS}](?=(?:[^"]*"[^"]*")*[^"]*$)')
_NUMBER = re.compile(r'[-+\d.,:]+')
_PARTS = ('yyyymmdd', 'year', 'yy', 'mess_datum', 'hora utc', 'vuosi')
_KINDS = ('speed', 'acceleration', 'rate')
"""Kinds of units of which a row of units has at least one."""
_WIND = ('wind_speed', 'wind_direction', 'wind_x', 'gust')


def header_line(lines: Sequence[str]) -> int | None:
    """
    Line of the header: the first with names of a time and, if there is one, of a wind.

    A comment is one only where no other line is, and with names of both.
    """
    timed: list[int] = []
    windy: list[int] = []
    hashed: list[int] = []
    for number, line in enumerate(lines[:_HEAD]):
        if not _has_time(line.lstrip('# ')):
            continue
        is_comment = line.startswith('#')
        if not is_comment:
            timed.append(number)
        if _has_wind(line.lstrip('# ')):
            (hashed if is_comment else windy).append(number)
    found = windy or timed or hashed
    return found[0] if found else None


def _cells(line: str) -> list[str]:
    return [cell.strip().strip('"') for cell in _CELL.split(line)]


def _has_time(line: str) -> bool:
    cells = _cells(line)
    if len(cells) < 2:
        return False
    return any(
        rank_of(cell, 'time') is not None or cell.strip().lower() in _PARTS
        for cell in cells[:_MOST_COLUMNS]
        if cell and _NUMBER.fullmatch(cell) is None
    )


def _has_wind(line: str) -> bool:
    cells = _cells(line)[:_MOST_COLUMNS]
    return any(rank_of(cell, each) is not None for cell in cells for each in _WIND)


def _is_table(lines: Sequence[str]) -> bool:
    return header_line(lines) is not None


def _read(lines: list[str], source: str) -> TextTable:
    first = header_line(lines) or 0
    lines[:first] = [''] * first
    lines[first] = lines[first].removeprefix('#')
    return _with_units_below(parse_table(lines, source))


def _with_units_below(table: TextTable) -> TextTable:
    """
    Return a table without its row of units, as Synoptic has one; itself without such a row.

    The row may have names too, as in ``風速(m/s)`` below ``WS``.
    """
    cells = [_unit_below(cell) for cell in table.split(table.texts[0])]
    is_unit = any(unit_known(kind, cell) for cell in cells for kind in _KINDS)
    if not is_unit or any(finite(cell) is not None for cell in cells):
        return table
    units = [
        '' if rank_of(name, 'time') is not None and not unit_known('time', cell) else cell
        for name, cell in zip(table.columns, cells, strict=False)
    ]
    return replace(
        table,
        numbers=table.numbers[1:],
        texts=table.texts[1:],
        units=tuple(units),
        unit_line=table.numbers[0],
    )


def _unit_below(cell: str) -> str:
    """Return a wind's unit in brackets behind a name; a cell without brackets as it is."""
    name, unit = name_and_unit(cell, 'speed')
    if name == cell:
        return cell
    return unit if any(unit_known(kind, unit) for kind in ('angle', *_KINDS)) else ''


PLAIN = Layout('table', _is_table, _read)
