# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Text that WeatherLink for Windows exports (Davis): two lines of names, then rows with tabs.

The names stand one above the other, ``Wind`` over ``Speed``. The units are those that the program
was set to, which the file does not say.
"""

from __future__ import annotations

from itertools import zip_longest
import re

from tree_sway.files.layouts.layout import begins, Layout
from tree_sway.files.layouts.plain import PLAIN
from tree_sway.files.table_file import TextTable

_NAMES = r'.*Wind.*\n\s*(?i:Date\s+Time\b.*\bSpeed\s+Dir\b).*\n'
_WORD = re.compile(r'\S+')


def _read(lines: list[str], source: str) -> TextTable:
    names = _names(lines[0], lines[1])
    rows = ['\t'.join(line.split()) if '\t' not in line else line for line in lines[2:]]
    return PLAIN.read(['', '\t'.join(names), *rows], source)


def _names(above: str, below: str) -> list[str]:
    """Names of the columns: by tabs, else by where the words of the second line stand."""
    if '\t' in below:
        pairs = zip_longest(above.split('\t'), below.split('\t'), fillvalue='')
        return [' '.join(' '.join(pair).split()) for pair in pairs]
    names = []
    for word in _WORD.finditer(below):
        begin, end = word.span()
        over = (o[0] for o in _WORD.finditer(above) if o.start() < end and o.end() > begin)
        names.append(f'{next(over, "")} {word[0]}'.strip())
    return names


WEATHERLINK_TEXT = Layout(begins(_NAMES), _read)
