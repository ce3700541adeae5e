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

from itertools import zip_longest
import re

from tree_sway.errors import FormatError
from tree_sway.files.cell_table import table_of_cells
from tree_sway.files.layouts.layout import begins, Layout
from tree_sway.files.table_file import TextTable

_FIRST = 'ダウンロードした時刻'
_GUST = '最大瞬間風速(m/s)'
_DIRECTION = '風向'
_QUALITY = '品質情報'
_MEANS = ('風速(m/s)', '平均風速(m/s)')
"""Elements that are a mean wind speed: of ten minutes or of a day."""
_STATIONS = 2
_ELEMENTS = 3
_ROW = re.compile(r'\d{4}/\d{1,2}/\d{1,2}')
_NAMES = ('time (Asia/Tokyo)', 'wind speed', 'wind direction', 'gust')
_UNITS = ('', 'm/s', '', 'm/s')
_DOUBTFUL = ('0', '1', '2')


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
    titles = [' '.join(filter(None, each)) for each in zip_longest(*head[_ELEMENTS:])]
    mean = next((each for each in _MEANS if each in titles), '')
    wanted = (titles[0], mean, f'{mean} {_DIRECTION}', _GUST, f'{mean} {_QUALITY}')
    rows = {}
    for number, line in enumerate(lines, start=1):
        if _ROW.match(line):
            cells = dict(zip(titles, map(str.strip, line.split(',')), strict=False))
            time, speed, *others, quality = (cells.get(title, '') for title in wanted)
            rows[number] = [time, '' if quality in _DOUBTFUL else speed, *others]
    return table_of_cells(_NAMES, rows.values(), source, [*rows], _UNITS)


JMA = Layout(begins(_FIRST), _read)
