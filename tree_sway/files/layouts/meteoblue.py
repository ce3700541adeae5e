# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
CSV of meteoblue's history, whose columns begin with the place: ``Basel Wind Speed [10 m]``.

Above the row ``timestamp,...`` stand rows of which one, ``unit``, has the unit of each column
(meteoblue, "history+", CSV). The lowest height with speed and direction is taken, 10 m.
"""

from __future__ import annotations

from collections.abc import Sequence
import re

from tree_sway.files.layouts.layout import Layout
from tree_sway.files.layouts.plain import PLAIN
from tree_sway.files.table_file import TextTable

_PLACE = re.compile(r'(?<=,)[^,]* (Wind Speed|Wind Direction|Wind Gust)(?: \[10 m\])?(?=,|$)')
_HEAD = 20


def _header(lines: Sequence[str]) -> int | None:
    """Row of the names, below that of the places; None without them."""
    if not lines[0].startswith('location,'):
        return None
    head = enumerate(lines[:_HEAD])
    return next((number for number, line in head if line.startswith('timestamp,')), None)


def _read(lines: list[str], source: str) -> TextTable:
    header = _header(lines) or 0
    above = [line if line.startswith('unit,') else '' for line in lines[:header]]
    names = _PLACE.sub(r'\1', lines[header])
    return PLAIN.read([*above, names, *lines[header + 1 :]], source)


METEOBLUE = Layout('meteoblue', lambda lines: _header(lines) is not None, _read)
