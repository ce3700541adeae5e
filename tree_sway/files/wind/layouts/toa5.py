# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
TOA5, the tables of Campbell Scientific's loggers.

Four header lines: the logger, the names, their units and how they were processed. The components
of a sonic, ``Ux Uy Uz``, point where the wind blows, in the axes of the instrument (CSAT3 manual,
2.3).
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

from tree_sway.files.table_file import split_row, TextTable
from tree_sway.files.wind.layouts.layout import Layout

_HEADER = 4


def _is_toa5(lines: Sequence[str]) -> bool:
    if len(lines) < _HEADER:
        return False
    return lines[0].lstrip('"').startswith('TOA5')


def _read(lines: list[str], source: str) -> TextTable:
    split = partial(split_row, separator=',')
    rows = [number for number in range(_HEADER, len(lines)) if lines[number].strip()]
    return TextTable(
        columns=tuple(split(lines[1])),
        numbers=[number + 1 for number in rows],
        texts=[lines[number] for number in rows],
        split=split,
        source=source,
        header_line=2,
        unit_line=3,
        units=tuple(split(lines[2])),
    )


TOA5 = Layout('toa5', _is_toa5, _read)
