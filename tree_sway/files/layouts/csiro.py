# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Time series of CSIRO's Environmental Modelling Suite: numbers alone below a commented head.

The head has ``## COLUMN2.name u`` and ``## COLUMN2.units ms-1`` of each column; times are such as
``days since 1990-01-01 00:00:00 +10``.
"""

from __future__ import annotations

from collections.abc import Sequence
import re

from tree_sway.files.layouts.layout import Layout
from tree_sway.files.table_file import parse_columns, TextTable

_ENTRY = re.compile(r'#+\s*COLUMN\d+\.(?:name\s+(\S+)|units\s+(.*?))\s*(?:since\s.*|\(.*)?')


def _columns(lines: Sequence[str]) -> list[str]:
    entries = [each.groups('') for each in map(_ENTRY.fullmatch, lines) if each]
    pairs = zip(entries[::2], entries[1::2], strict=False)  # a name, then its unit
    return [f'{name} [{unit}]' for (name, _), (_, unit) in pairs]


def _read(lines: list[str], source: str) -> TextTable:
    return parse_columns(lines, source, _columns(lines))


CSIRO = Layout(lambda lines: bool(_columns(lines)), _read)
