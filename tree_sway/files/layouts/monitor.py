# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
What a serial monitor shows: ``12:00:00.120 -> `` before each line, and pairs as ``ax:0.12``.

So does the Arduino IDE, whose plotter takes pairs. Its clock is the time where the lines have no
other. Sketches of Adafruit have a line for each quantity, ``Accel X: 0.12 Y: 0.34 Z: 9.81 m/s^2``,
those of SparkFun one for all, ``Acc (mg) [ 39.80, -3.01, 1002.35 ], Gyr (DPS) [ ... ]``.
"""

from __future__ import annotations

from collections.abc import Sequence
import re

from tree_sway.files.cell_table import table_of_cells
from tree_sway.files.layouts.layout import Layout
from tree_sway.files.layouts.plain import PLAIN
from tree_sway.files.table_file import SEPARATORS, TextTable

_CLOCK = 'monitor_time'
_LINE = re.compile(
    r'(?:(\d\d:\d\d:\d\d(?:\.\d+)?(?= ->)|\d{4}-\d\d-\d\d[T ][\d:.]+Z?(?=[, ]+\w+[:=] ?[-\d.]))'
    r'(?: -> ?|[, ]+))?(.*)'
)
"""Clock, or a date before pairs, if there is one, and text of a line."""
_PAIR = re.compile(
    r'(?<!\w)([A-Za-z][\w ]{0,60}?)\s{0,9}[:=]\s{0,9}'
    r'([-+]?[\d.]{1,40}(?:[eE][-+]?\d{1,3})?|[NESW]{1,3}\b)'
    r'\s{0,9}([A-Za-z°][\w°/^²]{0,20})?(?:[,;|\s]+|$)'
)
"""Name, number or point of the compass, and maybe a unit."""
_AXES = re.compile(
    r'\b([A-Za-z]\w{0,30}) '
    r'(?:X: ?([-\d.]+),?\s+Y: ?([-\d.]+),?\s+Z: ?([-\d.]+)\s*([a-z/^²\d]*)|'
    r'\((\w+)\) \[ *([-\d.]+), *([-\d.]+), *([-\d.]+) *\],?)',
    re.IGNORECASE,
)
"""Quantity, and either three axes and a unit or a unit and three axes."""
_HEAD = 40
"""Lines among which the first of a quantity is."""


def pairs_of(line: str) -> dict[str, str]:
    """Return the values of a line by their names, with their units behind these."""
    found = _PAIR.findall(line)
    return {f'{name}_{unit}' if unit else name: value for name, value, unit in found}


def _are_pairs(line: str) -> bool:
    return len(pairs_of(line)) > 1 and _PAIR.sub('', line) == ''


def _is_monitored(lines: Sequence[str]) -> bool:
    first = [line for line in lines[:3] if line.strip()]
    are_stamped = all(_LINE.findall(line)[0][0] for line in first)
    found = [
        _AXES.search(line) for line in lines[:_HEAD] if not line.lstrip().startswith(tuple('#%;/'))
    ]
    has_axes = sum(each is not None for each in found) > 1
    return len(first) > 1 and (are_stamped or has_axes or all(map(_are_pairs, first)))


def _read(lines: list[str], source: str) -> TextTable:
    clocks, texts = map(list, zip(*(_LINE.findall(line)[0] for line in lines), strict=True))
    if vectors := _vectors(clocks, texts):
        columns = [*dict.fromkeys(name for row in vectors.values() for name in row)]
        rows_of = [[row.get(name, '') for name in columns] for row in vectors.values()]
        return table_of_cells(columns, rows_of, source, [*vectors])
    filled = [text for text in texts if text.strip()]
    if not _are_pairs(filled[-1]):
        separator = max(SEPARATORS, key=filled[-1].count)
        is_named = any(map(str.isalpha, filled[0]))
        if is_named and clocks[0]:
            clocks[0] = _CLOCK
        pairs = zip(clocks, texts, strict=True)
        rows = [f'{clock}{separator}{text}' if clock else text for clock, text in pairs]
        return PLAIN.read(rows, source)
    names = [*pairs_of(filled[-1])]
    cells = {
        number: [clock, *(each.get(name, '') for name in names)]
        for number, (clock, each) in enumerate(zip(clocks, map(pairs_of, texts), strict=True), 1)
        if each
    }
    clock = _CLOCK if any(clocks) else ''
    return table_of_cells([clock, *names], cells.values(), source, [*cells])


def _vectors(clocks: Sequence[str], texts: Sequence[str]) -> dict[int, dict[str, str]]:
    """Return the quantities of three axes by their names, from each line of the first one on."""
    rows: dict[int, dict[str, str]] = {}
    row: dict[str, str] = {}
    first = ''
    for number, (clock, text) in enumerate(zip(clocks, texts, strict=True), 1):
        for quantity, x, y, z, behind, unit, *others in _AXES.findall(text):
            first = first or quantity
            if quantity == first:
                row = rows[number] = {_CLOCK: clock} if clock else {}
            axes = zip('XYZ', others if unit else (x, y, z), strict=True)
            row |= {f'{quantity} {axis} [{unit or behind}]': value for axis, value in axes}
    return rows


MONITOR = Layout(_is_monitored, _read)
