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

from tree_sway.files.layouts.layout import begins, Layout
from tree_sway.files.layouts.plain import units_above
from tree_sway.files.table_file import parse_table, TextTable

_FIRST = ' *conventions *, *g *, *badc-csv'
_BEGIN = 'data'
_END = 'end data'


def _read(lines: list[str], source: str) -> TextTable:
    words = [line.strip().lower() for line in lines]
    begin = words.index(_BEGIN) + 1 if _BEGIN in words else 0
    end = words.index(_END) if _END in words else len(lines)
    blank = [''] * begin  # keeps the numbers of the lines
    table = parse_table(blank + lines[begin:end], source)
    return replace(table, units=units_above(table, lines[:begin]))


BADC_CSV = Layout(begins(_FIRST, re.IGNORECASE), _read)
