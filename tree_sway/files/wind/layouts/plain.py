# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A table with a header, maybe below lines that a service puts before it, such as a place."""

from __future__ import annotations

from collections.abc import Sequence
import re

from tree_sway.files.column_names import rank_of
from tree_sway.files.table_file import parse_table, TextTable
from tree_sway.files.wind.layouts.layout import Layout

_HEAD = 40
_CELL = re.compile(r'[,;\t](?=(?:[^"]*"[^"]*")*[^"]*$)')
_NUMBER = re.compile(r'[-+\d.,:]+')
_PARTS = ('yyyymmdd', 'year', 'yy', 'mess_datum')
_WIND = ('wind_speed', 'wind_direction', 'wind_x', 'gust')


def header_line(lines: Sequence[str]) -> int | None:
    """Line of the header: the first with names of a time and, if there is one, of a wind."""
    timed = [number for number, line in enumerate(lines[:_HEAD]) if _has_time(line)]
    windy = [number for number in timed if _has_wind(lines[number])]
    return next(iter(windy or timed), None)


def _cells(line: str) -> list[str]:
    return [cell.strip().strip('"') for cell in _CELL.split(line)]


def _has_time(line: str) -> bool:
    cells = _cells(line)
    if line.startswith('#') or len(cells) < 2:
        return False
    return any(
        rank_of(cell, 'time') is not None or cell.strip().lower() in _PARTS
        for cell in cells[:200]
        if cell and _NUMBER.fullmatch(cell) is None
    )


def _has_wind(line: str) -> bool:
    return any(rank_of(cell, each) is not None for cell in _cells(line)[:200] for each in _WIND)


def _is_table(lines: Sequence[str]) -> bool:
    return header_line(lines) is not None


def _read(lines: list[str], source: str) -> TextTable:
    first = header_line(lines) or 0
    lines[:first] = [''] * first
    return parse_table(lines, source)


PLAIN = Layout('table', _is_table, _read)
