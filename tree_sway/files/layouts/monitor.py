# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
What a serial monitor shows: ``12:00:00.120 -> `` before each line, and pairs as ``ax:0.12``.

So does the Arduino IDE, whose plotter takes pairs. Its clock is the time where the lines have no
other.
"""

from __future__ import annotations

from collections.abc import Sequence
import re

from tree_sway.files.layouts.layout import Layout
from tree_sway.files.layouts.plain import PLAIN
from tree_sway.files.table_file import SEPARATORS, TextTable

_CLOCK = 'monitor_time'
_STAMP = re.compile(r'(\d\d:\d\d:\d\d(?:\.\d+)?) -> ?(.*)')
_PAIR = re.compile(r'([A-Za-z]\w*)\s*[:=]\s*([-+]?[\d.]+(?:[eE][-+]?\d+)?)[,;\s]*')


def _are_pairs(line: str) -> bool:
    return len(_PAIR.findall(line)) > 1 and _PAIR.sub('', line) == ''


def _is_monitored(lines: Sequence[str]) -> bool:
    first = [line for line in lines[:3] if line.strip()]
    return len(first) > 1 and (all(map(_STAMP.fullmatch, first)) or all(map(_are_pairs, first)))


def _read(lines: list[str], source: str) -> TextTable:
    stamped = [_STAMP.fullmatch(line) for line in lines]
    texts = [
        line if found is None else found[2] for line, found in zip(lines, stamped, strict=True)
    ]
    filled = [text for text in texts if text.strip()]
    if _are_pairs(filled[-1]):
        names = [name for name, _ in _PAIR.findall(filled[-1])]
        values = [dict(_PAIR.findall(text)) for text in texts]
        texts = [','.join(each.get(name, '') for name in names) for each in values]
        texts[0] = ','.join(names)  # the first row stands where the header is
        filled = texts
    separator = max(SEPARATORS, key=filled[-1].count)
    if stamped[0] is not None:
        clocks = ['' if found is None else found[1] for found in stamped]
        is_named = any(map(str.isalpha, texts[0]))
        clocks[0] = _CLOCK if is_named else clocks[0]
        texts = [
            clock + separator + text if text.strip() else ''
            for clock, text in zip(clocks, texts, strict=True)
        ]
    return PLAIN.read(texts, source)


MONITOR = Layout('serial monitor', _is_monitored, _read)
