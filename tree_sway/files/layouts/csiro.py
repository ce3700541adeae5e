# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Time series of CSIRO's Environmental Modelling Suite: numbers alone below a commented head.

The head has ``## COLUMN2.name u`` and ``## COLUMN2.units ms-1`` of each column; times are such as
``days since 1990-01-01 00:00:00 +10``.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
import re

from tree_sway.files.layouts.layout import Layout
from tree_sway.files.table_file import parse_columns, TextTable

_ENTRY = re.compile(r'#+\s*COLUMN(\d+)\.(name|units)\s+(\S.*)')
_SINCE = re.compile(r'\s+since\s.*|\s*\(.*')


def _told(lines: Sequence[str], what: str) -> dict[int, str]:
    entries = filter(None, map(_ENTRY.match, lines))
    return {int(each[1]): each[3].strip() for each in entries if each[2] == what}


def _is_csiro(lines: Sequence[str]) -> bool:
    return bool(_told(lines, 'name'))


def _read(lines: list[str], source: str) -> TextTable:
    names, units = _told(lines, 'name'), _told(lines, 'units')
    table = parse_columns(lines, source, list(names.values()))
    plain = [_SINCE.sub('', units.get(number, '')) for number in names]
    return replace(table, units=tuple(plain))


CSIRO = Layout('csiro', _is_csiro, _read)
