# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Columns with spaces between them, under a line of names that begins with a hash.

NDBC's buoys have ``#YY MM DD hh mm WDIR WSPD GST`` and a line of units (Measurement Descriptions
and Units, ndbc.noaa.gov). KNMI's hours of the Netherlands have commas and ``# STN,YYYYMMDD, HH``.
"""

from __future__ import annotations

from collections.abc import Sequence
import re

from tree_sway.files.cell_table import numbered, table_of_lines
from tree_sway.files.layouts.layout import Layout
from tree_sway.files.table_file import TextTable

_NAMES = re.compile(r'#\s*(YY+\s+MM\s+DD|STN\s*,\s*YYYYMMDD)\b')
_HEAD = 200
_CLOCK = 'YY YYYY MM DD hh minute'.split()


def _find_names(lines: Sequence[str]) -> int | None:
    return next((i for i, line in enumerate(lines[:_HEAD]) if _NAMES.match(line)), None)


def _has_names(lines: Sequence[str]) -> bool:
    return _find_names(lines) is not None


def _cells(line: str) -> list[str]:
    text = line.lstrip('#').strip()
    if ',' not in text:
        return text.split()
    return [cell.strip() for cell in text.split(',')]


def _read(lines: list[str], source: str) -> TextTable:
    begin = _find_names(lines) or 0
    columns = _cells(lines[begin])
    below = lines[begin + 1] if begin + 1 < len(lines) else ''
    has_units = below.startswith('#') and len(below) > 2
    units = _cells(below) if has_units else []
    rows = [
        (number, _cells(line))
        for number, line in numbered(lines, begin + 1)
        if line.strip() and not line.startswith('#')
    ]
    # Of NDBC's two columns mm and MM one is the minute; units of the time are its parts.
    names = ['minute' if name == 'mm' else name for name in columns]
    pairs = zip(names, units, strict=False)
    known_units = ['' if name in _CLOCK else unit for name, unit in pairs]
    return table_of_lines(names, rows, source, known_units)


SPACED = Layout('spaced', _has_names, _read)
