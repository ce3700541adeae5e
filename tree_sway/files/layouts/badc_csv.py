# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
BADC-CSV, the files of the Met Office's stations (MIDAS) and of other British archives.

Lines of metadata, ``long_name,wind_speed,wind speed,knots`` with the unit of a column, come before
a line ``data``; the table is below, up to ``end data`` (CEDA, BADC-CSV format, version 1).
"""

from __future__ import annotations

from dataclasses import replace
import re

from tree_sway.files.layouts.layout import Layout
from tree_sway.files.table_file import parse_table, split_row, TextTable

_FIRST = re.compile(' *conventions *, *g *, *badc-csv', re.IGNORECASE)
_BEGIN = 'data'
_END = 'end data'
_UNIT = 3
"""Field of a line ``long_name`` with the unit."""


def _read(lines: list[str], source: str) -> TextTable:
    words = [line.strip().lower() for line in lines]
    begin = words.index(_BEGIN) + 1 if _BEGIN in words else 0
    end = words.index(_END) if _END in words else len(lines)
    units = {}
    for line in lines[:begin]:
        fields = split_row(line, ',')
        if len(fields) > _UNIT and fields[0] == 'long_name':
            units[fields[1]] = fields[_UNIT]
    blank = [''] * begin  # keeps the numbers of the lines
    table = parse_table(blank + lines[begin:end], source)
    units_of_columns = [units.get(column, '') for column in table.columns]
    return replace(table, units=tuple(units_of_columns))


BADC_CSV = Layout('badc-csv', lambda lines: _FIRST.match(lines[0]) is not None, _read)
