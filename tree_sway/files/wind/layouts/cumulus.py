# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Files of Cumulus and Cumulus MX: the log of a month, and ``realtime.txt``.

Neither has a header. A line of the log begins with ``19/08/09,16:03``; the sixth field is the mean
speed, the seventh the gust, the eighth the bearing, and no field tells their unit (Cumulus Wiki,
"Standard log files"). The fields of ``realtime.txt`` have spaces between them, and the fourteenth
is the unit (Cumulus Wiki, "Realtime.txt"). Decimals have a comma where the computer has one.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
import re

from tree_sway.files.cell_table import numbered, NumberedRow, table_of_lines
from tree_sway.files.column_names import unit_known
from tree_sway.files.table_file import TextTable
from tree_sway.files.wind.layouts.layout import Layout

_LOG = re.compile(r'\d\d[/.-]\d\d[/.-]\d\d([,;])\d\d[:.]\d\d\1(?:-?[\d.,]*\1){12}.*')
# The first names the maker, by which the missing unit is told.
_LOG_NAMES = ('Cumulus log', 'time', 'wind speed', 'gust', 'wind direction')

SPEED, BEARING, UNIT, GUST = 5, 7, 13, 40
"""Fields of ``realtime.txt``, from 0: the mean speed, where it comes from, unit, and gust."""


def fields_of_realtime(line: str) -> list[str] | None:
    """Return the fields of a line of ``realtime.txt`` with decimal points; None if it is none."""
    fields = line.replace(',', '.').split()
    if len(fields) <= GUST or not unit_known('speed', fields[UNIT]):
        return None
    return fields


def _is_log(lines: Sequence[str]) -> bool:
    return bool(lines) and _LOG.fullmatch(lines[0].strip()) is not None


def _read_log(lines: list[str], source: str) -> TextTable:
    return table_of_lines(_LOG_NAMES, _rows_of_log(lines), source)


def _rows_of_log(lines: Sequence[str]) -> Iterator[NumberedRow]:
    for number, line in numbered(lines):
        if line.strip():
            yield number, _row_of_log(line.strip())


def _row_of_log(line: str) -> list[str]:
    """Cells of a line by `_LOG_NAMES`; empty ones if it is broken."""
    found = _LOG.fullmatch(line)
    if found is None:
        return [''] * len(_LOG_NAMES)
    date, clock, *cells = line.split(found[1])
    wind = [cell.replace(',', '.') for cell in cells[3:6]]
    return ['', _stamp(date, clock), *wind]


def _stamp(date: str, clock: str) -> str:
    """Return a time of ISO 8601 from ``19/08/09`` and ``16:03``."""
    day, month, year = re.split(r'[/.-]', date)
    return f'20{year}-{month}-{day} {clock.replace(".", ":")}'


def _is_realtime(lines: Sequence[str]) -> bool:
    return bool(lines) and fields_of_realtime(lines[0]) is not None


def _read_realtime(lines: list[str], source: str) -> TextTable:
    first = fields_of_realtime(lines[0])
    assert first is not None
    unit = first[UNIT]
    units = ('', unit, unit, 'deg')
    return table_of_lines(_LOG_NAMES[1:], _rows_of_realtime(lines), source, units)


def _rows_of_realtime(lines: Sequence[str]) -> Iterator[NumberedRow]:
    for number, line in numbered(lines):
        fields = fields_of_realtime(line)
        if fields is not None:
            stamp = _stamp(fields[0], fields[1])
            yield number, [stamp, fields[SPEED], fields[GUST], fields[BEARING]]


CUMULUS_LOG = Layout('cumulus log', _is_log, _read_log)
CUMULUS_REALTIME = Layout('cumulus realtime', _is_realtime, _read_realtime)
