# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Lines of tags and values behind a date: ``2026-06-01 12:00:00.000 S 04.62 D 240 U 4.62 ...``.

So send Anemoment's TriSonica and loggers of it (TriSonica Mini user manual): S the speed in m/s, D
the direction in degrees that the wind comes from.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
import re

from tree_sway.files.cell_table import numbered, NumberedRow, table_of_lines
from tree_sway.files.table_file import TextTable
from tree_sway.files.wind.layouts.layout import Layout

_LINE = re.compile(r'(\d{4}-\d\d-\d\d[ T][\d:.]+Z?)[ ,]+S\s+([\d.]+)\s+D\s+([\d.]+)\b.*', re.ASCII)


def _has_tags(lines: Sequence[str]) -> bool:
    return len(lines) > 1 and all(map(_LINE.fullmatch, lines[:2]))


def _read(lines: list[str], source: str) -> TextTable:
    columns, units = 'time wind_speed wind_direction'.split(), ('', 'm/s', 'deg')
    return table_of_lines(columns, _rows(lines), source, units)


def _rows(lines: Sequence[str]) -> Iterator[NumberedRow]:
    for number, line in numbered(lines):
        found = _LINE.fullmatch(line)
        yield number, list(found.groups()) if found else ['', '', '']


TAGGED = Layout('tagged', _has_tags, _read)
