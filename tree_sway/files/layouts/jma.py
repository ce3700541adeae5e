# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Files of the Japan Meteorological Agency: "past weather data, download", hourly or ten-minute wind.

The first line tells the time of the download, the third the stations, the fourth the elements.
Lines below name the further columns of an element, such as its direction (風向) and its quality
(品質情報): 8 is good, 5 and 4 are of incomplete data, below that it is doubtful. Times are
those of Japan, directions points of the compass (JMA, "format of the CSV file").
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
import re

from tree_sway.errors import FormatError
from tree_sway.files.cell_table import cell_at, numbered, NumberedRow, table_of_lines
from tree_sway.files.layouts.layout import Layout
from tree_sway.files.table_file import TextTable

_FIRST = 'ダウンロードした時刻'
_SPEED = '風速(m/s)'
_GUST = '最大瞬間風速(m/s)'
_DIRECTION = '風向'
_QUALITY = '品質情報'
_MEANS = (_SPEED, '平均風速(m/s)')
"""Elements that are a mean wind speed: of ten minutes or of a day."""
_STATIONS = 2
_ELEMENTS = 3
_ROW = re.compile(r'\d{4}/\d{1,2}/\d{1,2}')
_NAMES = ('time (Asia/Tokyo)', 'wind speed', 'wind direction', 'gust')
_UNITS = ('', 'm/s', '', 'm/s')
_DOUBTFUL = ('0', '1', '2')


def _is_jma(lines: Sequence[str]) -> bool:
    return lines[0].startswith(_FIRST)


def _read(lines: list[str], source: str) -> TextTable:
    first = next((number for number, line in enumerate(lines) if _ROW.match(line)), 0)
    if first <= _ELEMENTS:
        raise FormatError('a file of JMA without rows')
    head = [line.split(',') for line in lines[:first]]
    stations = {name for name in head[_STATIONS] if name.strip()}
    if len(stations) > 1:
        raise FormatError(
            f'several stations: {", ".join(sorted(stations)[:5])}', cure='download one at a time'
        )
    rows = _rows(lines, first, head[_ELEMENTS:])
    return table_of_lines(_NAMES, rows, source, _UNITS)


def _rows(lines: Sequence[str], first: int, head: Sequence[list[str]]) -> Iterator[NumberedRow]:
    """Yield the rows from a line on; the head has the elements, and the labels below them."""
    mean = next((each for each in _MEANS if each in head[0]), _SPEED)
    speed = _column(head, mean, [])
    direction = _column(head, mean, [_DIRECTION])
    gust = _column(head, _GUST, [])
    quality = _column(head, mean, [_QUALITY])
    for number, line in numbered(lines, first):
        if _ROW.match(line):
            cells = line.split(',')
            is_doubtful = cell_at(cells, quality) in _DOUBTFUL
            known_speed = '' if is_doubtful else cell_at(cells, speed)
            yield number, [cells[0], known_speed, cell_at(cells, direction), cell_at(cells, gust)]


def _column(head: Sequence[list[str]], element: str, labels: list[str]) -> int | None:
    """Place of the column of an element with labels below it; None without one."""
    elements, *below = head
    for place, name in enumerate(elements):
        found = [cell_at(row, place) for row in below]
        if name == element and list(filter(None, found)) == labels:
            return place
    return None


JMA = Layout('jma', _is_jma, _read)
