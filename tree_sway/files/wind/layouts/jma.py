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

from collections.abc import Sequence
import re

from tree_sway.errors import FormatError
from tree_sway.files.cell_table import table_of_lines
from tree_sway.files.table_file import TextTable
from tree_sway.files.wind.layouts.layout import Layout

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
    return bool(lines) and lines[0].startswith(_FIRST)


def _read(lines: list[str], source: str) -> TextTable:
    cells = [line.split(',') for line in lines]
    first = next((k for k, row in enumerate(cells) if _ROW.match(row[0])), len(cells))
    if first <= _ELEMENTS:
        raise FormatError('a file of JMA without rows', where=source)
    stations = {name for name in cells[_STATIONS] if name.strip()}
    if len(stations) > 1:
        what = f'several stations: {", ".join(sorted(stations)[:5])}'
        raise FormatError(what, where=source, cure='download one at a time')
    elements = cells[_ELEMENTS]
    labels = cells[_ELEMENTS + 1 : first]
    mean = next((each for each in _MEANS if each in elements), _SPEED)
    columns = [
        _column(elements, labels, mean, ()),
        _column(elements, labels, mean, (_DIRECTION,)),
        _column(elements, labels, _GUST, ()),
        _column(elements, labels, mean, (_QUALITY,)),
    ]
    rows = []
    for number, row in enumerate(cells[first:], start=first + 1):
        if _ROW.match(row[0]):
            speed, direction, gust, quality = (_cell(row, column) for column in columns)
            known_speed = '' if quality in _DOUBTFUL else speed
            rows.append((number, [row[0], known_speed, direction, gust]))
    return table_of_lines(_NAMES, rows, source, _UNITS)


def _column(
    elements: Sequence[str], labels: Sequence[Sequence[str]], element: str, wanted: Sequence[str]
) -> int | None:
    """Place of the column of an element with labels below it; None without one."""
    for column, name in enumerate(elements):
        below = [row[column] for row in labels if column < len(row) and row[column]]
        if name == element and below == list(wanted):
            return column
    return None


def _cell(row: Sequence[str], column: int | None) -> str:
    return row[column].strip() if column is not None and column < len(row) else ''


JMA = Layout('jma', _is_jma, _read)
